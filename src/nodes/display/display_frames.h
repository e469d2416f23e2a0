#pragma once

#include <tf2_msgs/TFMessage.h>

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "nodes/runtime/frames.h"

namespace microinjection {

/// Republishes the rig's frames, enlarged, below viz/world, NAME as viz/NAME, for rviz only.
class DisplayFrames {
 public:
  /// @param fixed  frames of tf that rarely move; republished as static transforms
  DisplayFrames(Bus& bus, const std::vector<std::string>& fixed, double enlargement);

  /// Republishes changed frames; call it regularly.
  void update();

  /// Publishes viz/needle_tip. @param tip  finite pose of needle_tip in world (m).
  void publishNeedleTip(const Eigen::Isometry3d& tip);

  /// Pose of `frame` in `parent` (m); empty while tf has none.
  std::optional<Eigen::Isometry3d> find(const std::string& parent, const std::string& frame) const;

  /// Fixed frames that tf does not have yet; empty: none.
  std::vector<std::string> missing() const;

 private:
  void publishFixed(const geometry_msgs::TransformStamped& transform);

  Bus& bus_;
  std::vector<std::string> fixed_;
  double enlargement_;
  FrameListener frames_;
  Publisher<tf2_msgs::TFMessage> tf_, static_tf_;
  tf2_msgs::TFMessage fixed_message_;                   ///< the last one: a late subscriber needs all fixed frames
  std::map<std::string, Eigen::Isometry3d> published_;  ///< fixed frames in world (m), as last published
  double tip_stamp_ = 0;                                ///< s, of the last viz/needle_tip
};

}  // namespace microinjection
