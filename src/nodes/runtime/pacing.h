#pragma once

#include <ros/ros.h>

#include <functional>

namespace microinjection {

/// What a cycle gives to the strategy that decides when it steps (LivePacing, LockstepPacing).
struct CycleSteps {
  std::function<bool()> should_continue;
  std::function<void(const ros::Time& now)> step;
};

}  // namespace microinjection
