#pragma once

#include <ros/time.h>

#include "nodes/runtime/stamps.h"

namespace microinjection {

/// Since when a message without a stamp may have waited before this node heard it. A node that was frozen, or kept from
/// the processor, finds old messages; they come some steps after it has gone on, since roscpp reads them in another
/// thread.
class StallWatch {
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

  /// Of a message that is heard now: it cannot have been here before. Zero before the first step.
  ros::Time earliest() const { return before_.isZero() ? last_ : before_; }

 private:
  static constexpr double kGap = 0.1;   // s
  static constexpr double kTime = 0.2;  // s, and
  static constexpr int kSteps = 20;     // after a gap, in which old messages come

  ros::Time last_, before_, ended_;
  int steps_ = 0;
};

}  // namespace microinjection
