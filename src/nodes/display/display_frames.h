#pragma once

#include <ros/node_handle.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

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
  DisplayFrames(const ros::NodeHandle& node, const std::vector<std::string>& fixed, double enlargement);

  /// Republishes changed frames; call it regularly.
  void update();

  /// Publishes viz/needle_tip. @param tip  finite pose of needle_tip in world (m).
  void publishNeedleTip(const Eigen::Isometry3d& tip);

  /// Pose of `frame` in `parent` (m); empty while tf has none.
  std::optional<Eigen::Isometry3d> find(const std::string& parent, const std::string& frame) const;

  /// Fixed frames that tf does not have yet; empty: none.
  std::vector<std::string> missing() const;

 private:
  std::vector<std::string> fixed_;
  double enlargement_;
  FrameListener frames_;
  tf2_ros::StaticTransformBroadcaster static_broadcaster_;
  tf2_ros::TransformBroadcaster broadcaster_;
  std::map<std::string, Eigen::Isometry3d> published_;  ///< fixed frames in world (m), as last published
  double tip_stamp_ = 0;                                ///< s, of the last viz/needle_tip
};

}  // namespace microinjection
