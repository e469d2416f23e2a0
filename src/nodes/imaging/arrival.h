#pragma once

#include <ros/time.h>

namespace microinjection {

/// When a message was stamped, and when it arrived. The older of the two counts: a relay that
/// repeats an old message must not keep it fresh, and neither must a clock that was set back.
class Arrival {
 public:
  Arrival() = default;  ///< of a message that never came
  explicit Arrival(const ros::Time& stamp) : stamp_(stamp), received_(ros::SteadyTime::now()) {}

  /// Whether it is older than `timeout` (s) by now, is stamped ahead of this host's time, or never
  /// came.
  bool isOld(double timeout) const;

 private:
  ros::Time stamp_;
  ros::SteadyTime received_;
};

}  // namespace microinjection
