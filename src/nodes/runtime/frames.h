#pragma once

#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "nodes/bus/bus.h"

namespace microinjection {

/// Receives tf. It ignores transforms that are stamped ahead, not
/// finite or longer than kLargestTranslation. tf2_ros's own listener would end the program at a
/// stamp near the largest time.
class FrameListener {
 public:
  explicit FrameListener(Bus& bus);

  /// The newest pose of `frame` in `parent`; empty when tf has none.
  std::optional<Eigen::Isometry3d> find(const std::string& parent, const std::string& frame) const;

 private:
  static constexpr double kLargestTranslation = 1e3;  // m

  void receive(const tf2_msgs::TFMessage& message, const std::string& sender, bool is_static);

  Bus& bus_;
  tf2::BufferCore buffer_;
  ros::Time newest_;  ///< this node's time at the last message
  Subscription moving_, static_;
};

/// Waits up to `timeout` (s of wall time, since a simulated clock may not run yet) for a fixed
/// pose.
/// @throws ConfigError naming the missing transform and its usual publishers
Eigen::Isometry3d waitForFrame(Bus& bus, const std::string& parent, const std::string& frame, double timeout);

}  // namespace microinjection
