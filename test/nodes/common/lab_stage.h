#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/JointState.h>

#include <Eigen/Core>
#include <memory>
#include <string>

#include "cell_microinjection/OperatingState.h"
#include "cell_microinjection/StringStamped.h"
#include "hardware/manipulator/manipulator_geometry.h"
#include "nodes/bus/bus.h"

namespace microinjection {

/// A stage with three motors, as a laboratory drives it by a node of its own, and what may be wrong with that node. The
/// stage stays where it is when the node ends. Written from CRTK's convention (api-robot-motion, api-operating-state).
struct LabStage {
  explicit LabStage(const std::string& urdf) : geometry(ManipulatorGeometry::fromUrdf(urdf)) {}

  ManipulatorGeometry geometry;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, of the motors
  Eigen::Vector3d target = Eigen::Vector3d::Zero();    ///< m
  double time_constant = 5e-3;                         ///< s, of its servo
  std::string first_state = "ENABLED";                 ///< of its node, when that starts
  std::string state;
  bool homed = true;
  std::string last_word;  ///< heard on state_command

  double period = 0.01;    ///< s, in which it tells its position
  ros::Time silent_until;  ///< it has no connection to its motors
  bool repeats_stamp = false, stamps_nothing = false;
  double told_beside = 0;                    ///< m, added to each position that it tells
  std::string joint = "z", frame = "world";  ///< names of the third joint, and of the poses' frame
  bool obeys = true;                         ///< it moves as it is told
  bool pursues_old_targets = false;          ///< when it is enabled again
  double own_speed = 0;                      ///< m/s along x, by a joystick of its own

  Eigen::Vector3d tip() const { return geometry.tip(position); }
  /// silence:S or pull:S, and error:CODE.
  void inject(const std::string& fault, const ros::Time& now);
};

/// Its node: below /my_rig.
/// Out: measured_js, measured_cp, operating_state (latched). In: servo_jp, servo_cp, state_command
class LabStageNode {
 public:
  LabStageNode(Bus& bus, LabStage& stage);

 private:
  void step(const ros::Time& now);
  void move(double dt);
  void tell(const ros::Time& now);
  void change(const std::string& state);
  void command(const std::string& word);
  void aim(const Eigen::Vector3d& target);

  Bus& bus_;
  LabStage& stage_;
  Publisher<sensor_msgs::JointState> joints_;
  Publisher<geometry_msgs::PoseStamped> poses_;
  Publisher<cell_microinjection::OperatingState> states_;
  Subscription joint_commands_, pose_commands_, words_;
  ros::Time stepped_, told_, stamp_;
  std::string told_state_;
  bool told_homed_ = false;
};

}  // namespace microinjection
