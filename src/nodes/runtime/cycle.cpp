#include "nodes/runtime/cycle.h"

#include <algorithm>

#include "nodes/runtime/lockstep.h"

namespace microinjection {

Cycle::Cycle(const ros::NodeHandle& node, double rate)
    : period_(1 / rate),
      ports_(node),
      live_(ports_, period_),
      lockstep_(takesPartInLockstep() ? std::make_unique<LockstepPacing>(ports_) : nullptr),
      diagnostics_(rate),
      master_(!deterministic()) {}

bool Cycle::shouldContinue() {
  if (master_.masterLostForLong() && !busy_) {
    ROS_ERROR("the ROS master has been away for too long, and nothing moves: this node ends");
    stopped_ = true;
  }
  if (lockstep_ && lockstep_->hasLeft()) {
    ROS_ERROR("the lock step goes on without this node, which was frozen: it ends");
    stopped_ = true;
  }
  return ros::ok() && !stopped_;
}

void Cycle::run(const std::function<void(const Tick&)>& step) {
  step_ = step;
  // The first line of a node's log waits for a parameter of rosout from the master, so log it
  // before stepping.
  ROS_INFO_STREAM("steps " << (lockstep_ ? "in lock step" : "live") << ", nominally each " << period_ << " s");
  const CycleSteps steps{[this] { return shouldContinue(); }, [this](const ros::Time& now) { this->step(now); }};
  lockstep_ ? lockstep_->run(steps) : live_.run(steps);
}

void Cycle::step(const ros::Time& now) {
  ports_.sampled_queue.callAvailable();
  ports_.stalls.step(now);
  if (now.isZero()) return;  // the simulated clock has not started
  if (now < last_step_) {    // the clock was set back: all received messages are invalid
    for (auto& input : ports_.inputs) input->invalidate();
    last_step_ = now;
  }
  const double dt = last_step_.isZero() ? period_ : secondsBetween(last_step_, now);
  if (dt <= 0) return;  // the simulated clock stands still
  checkMaster();
  diagnostics_.beginStep();
  step_({now, std::min(dt, 10 * period_)});
  diagnostics_.endStep(now);
  last_step_ = now;
}

void Cycle::checkMaster() {
  const bool lost = master_.lost();
  if (lost == master_lost_) return;
  master_lost_ = lost;
  for (auto& input : ports_.inputs) input->disconnected = lost;
  if (lost) {
    ROS_ERROR("the ROS master is lost, or a new one that does not know this node: no input counts");
  } else {
    ROS_INFO("the ROS master is back");
  }
}

}  // namespace microinjection
