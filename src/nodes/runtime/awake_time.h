#pragma once

#include <ros/time.h>

#include <algorithm>

#include "nodes/runtime/stamps.h"

namespace microinjection {

/// The time for which this node has been running. While a node stands still it hears nobody, so that
/// time says nothing about the silence of others. Messages that waited meanwhile arrive some steps later.
class AwakeTime {
 public:
  /// Must be called at least every kLongestStep.
  void step(const ros::SteadyTime& now) {
    if (!last_.isZero()) seconds_ += std::min(secondsBetween(last_, now), kLongestStep);
    last_ = now;
  }
  double seconds() const { return seconds_; }  ///< s

  static constexpr double kLongestStep = 0.1;  ///< s that a late step counts for

 private:
  ros::SteadyTime last_;
  double seconds_ = 0;  // s
};

}  // namespace microinjection
