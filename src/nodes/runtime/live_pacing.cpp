#include "nodes/runtime/live_pacing.h"

namespace microinjection {

void LivePacing::run(const CycleSteps& steps) {
  const bool driven = std::any_of(ports_.inputs.begin(), ports_.inputs.end(),
                                  [](const auto& input) { return input->phase == InputPhase::kThisTick; });
  ros::SteadyTime deadline = ros::SteadyTime::now();
  while (steps.should_continue()) {
    const ros::WallDuration wait(secondsBetween(ros::SteadyTime::now(), deadline));
    ports_.queue.callAvailable(std::clamp(wait, ros::WallDuration(0), ros::WallDuration(0.1)));
    const ros::SteadyTime now = ros::SteadyTime::now();
    if (!triggered_ && now < deadline) continue;
    // The node does not wait for an input that is late by half a period.
    deadline =
        driven ? now + ros::WallDuration((triggered_ ? 1.5 : 1.0) * period_) : deadline + ros::WallDuration(period_);
    if (secondsBetween(deadline, now) > 10 * period_) deadline = now;  // after a stall: do not catch up
    triggered_ = false;
    steps.step(ros::Time::now());
  }
}

}  // namespace microinjection
