#pragma once

#include <ros/time.h>

#include "nodes/runtime/stamps.h"

namespace microinjection {

/// Bounds the time that a message without a stamp may have waited before this node received it. A
/// node that was frozen, or without the processor, finds old messages. They arrive some steps after
/// it continues, since roscpp reads them in another thread.
class StallMonitor {
 public:
  void step(const ros::Time& now) {
    if (!last_.isZero() && secondsBetween(last_, now) > kGap) {
      before_ = last_;
      ended_ = now;
      steps_ = 0;
    }
    const bool set_back = now < last_;
    last_ = now;
    const bool settled = ++steps_ >= kSteps && secondsBetween(ended_, now) >= kTime;
    if (settled || set_back) before_ = ros::Time();
  }

  /// Earliest arrival of a message that is received now. Zero before the first step.
  ros::Time earliest() const { return before_.isZero() ? last_ : before_; }

 private:
  static constexpr double kGap = 0.1;   // s
  static constexpr double kTime = 0.2;  // s, and
  static constexpr int kSteps = 20;     // after a gap, during which old messages arrive

  ros::Time last_, before_, ended_;
  int steps_ = 0;
};

}  // namespace microinjection
