#include "nodes/runtime/cycle.h"

#include <ros/console.h>

#include <algorithm>
#include <utility>

namespace microinjection {

Cycle::Cycle(Bus& bus, double rate) : bus_(bus), period_(1 / rate), diagnostics_(bus, rate) {}

void Cycle::onStep(std::function<void(const Tick&)> step) {
  step_ = std::move(step);
  bus_.setStep(period_, [this](const ros::Time& now) { this->step(now); });
}

void Cycle::step(const ros::Time& now) {
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
  const bool lost = bus_.isLost();
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
