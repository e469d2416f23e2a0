#pragma once

#include <actionlib/server/simple_action_server.h>
#include <cell_microinjection/GoToPixelAction.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/PointStamped.h>
#include <ros/ros.h>

#include <memory>
#include <optional>
#include <string>

#include "nodes/imaging/tip_watch.h"
#include "nodes/runtime/master_monitor.h"
#include "vision/calibration/image_approach.h"

namespace microinjection {

/// Brings the tip to a pixel (visual servoing). It takes the hand's place: its set-points go through
/// the controller, whose limits and guards hold.
///
/// In:  vision/state, /needle/measured_cp, /controller/operating_state; visual_servo/proposed_pixel, where a click
/// wants
///      the tip (px; stamp 0: nowhere; forgotten after a minute)
/// Out: /teleop/servo_cp while a goal is active; visual_servo/proposed_point, the needle's position that has the tip at
///      the proposed pixel (m, world, at its present y; stamp 0: none, or not known); the action
///      visual_servo/go_to_pixel (GoToPixel)
///
/// Parameters: config/visual_servo.yaml
class VisualServoNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError when a parameter is unknown or out of range.
  VisualServoNode(ros::NodeHandle node, ros::NodeHandle private_node);
  void run();

 private:
  struct Parameters {
    std::string calibration;     ///< file, see calibrationPath()
    double input_timeout = 0.5;  ///< s
    ImageApproachConfig approach;
  };
  static Parameters readParameters(const ros::NodeHandle& private_node);

  void onProposal(const geometry_msgs::PointStamped& message);
  std::optional<Eigen::Vector3d> proposedPoint() const;  ///< m; none: nothing is proposed, or the place is not known
  void publishProposal();
  void onGoal();
  void begin(const Eigen::Vector2d& pixel);  ///< throws ConfigError with the reason for a refusal
  bool isEngaged();
  void publish(const Eigen::Vector3d& setpoint, const ros::Time& now);
  void step();
  void finish(bool success, const std::string& message);

  Parameters parameters_;
  ros::NodeHandle node_;
  TipWatch watch_;
  std::optional<CameraCalibration> calibration_;     ///< of the goal; none: no goal is active
  Eigen::Vector2d pixel_ = Eigen::Vector2d::Zero();  ///< px, of the goal
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();  ///< m, of the goal
  ros::SteadyTime accepted_, began_;                 ///< of the goal, and of the connection to the controller
  std::unique_ptr<ImageApproach> approach_;          ///< null: the controller has not engaged yet
  ros::Publisher setpoints_;                         ///< while a goal is active, so that a hand finds the topic free
  struct Proposal {
    Eigen::Vector2d pixel{0, 0};  ///< px
    ros::SteadyTime received;
    CameraCalibration calibration;
  };
  std::optional<Proposal> proposal_;
  ros::Publisher proposed_point_;
  bool proposal_published_ = false;
  ros::SteadyTime proposal_published_at_;
  ros::Subscriber proposed_pixel_;
  ros::Subscriber others_;  ///< counts the publishers of the set-points
  MasterMonitor master_{true};
  actionlib::SimpleActionServer<cell_microinjection::GoToPixelAction> action_;
  diagnostic_updater::Updater diagnostics_;
  ros::SteadyTimer timer_;
};

}  // namespace microinjection
