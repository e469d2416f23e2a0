#pragma once

#include <ros/time.h>

namespace microinjection {

/// When a message was stamped, and when it arrived. The older of the two counts: a relay that
/// repeats an old message must not keep it fresh, and neither must a clock that was set back.
class Receipt {
 public:
  Receipt() = default;  ///< of a message that never came
  /// `received`: steady time.
  Receipt(const ros::Time& stamp, const ros::SteadyTime& received) : stamp_(stamp), received_(received) {}

  /// Whether the message is older than `timeout` (s) at the time `now`, which is also `steady`, is
  /// stamped ahead of it, or never came.
  bool isOld(double timeout, const ros::Time& now, const ros::SteadyTime& steady) const;

 private:
  ros::Time stamp_;
  ros::SteadyTime received_;
};

}  // namespace microinjection
