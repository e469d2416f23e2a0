#pragma once

#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include <vector>

#include "hardware/manipulator/rig_model.h"
#include "nodes/bus/bus.h"

namespace microinjection {

/// The frames of the rig in virtual time: what robot_state_publisher and static_transform_publisher
/// publish in a live session.
///
/// In:  joint_states
/// Out: /tf (frames that joints move), /tf_static (all others)
///
/// Parameters: /robot_description; ~frames: a list of {parent, child, pose: [x, y, z, yaw, pitch, roll]}
/// (m, rad), frames beside those of the URDF
class RigFramesNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError when the URDF or a frame is wrong
  explicit RigFramesNode(Bus& bus);

 private:
  void onJoints(const sensor_msgs::JointState& message);

  Bus& bus_;
  urdf::ModelInterfaceSharedPtr model_;
  std::vector<geometry_msgs::TransformStamped> fixed_;
  Publisher<tf2_msgs::TFMessage> static_frames_, moving_frames_;
  Subscription joints_;
};

}  // namespace microinjection
