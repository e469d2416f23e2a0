#pragma once

#include <cell_microinjection/GoToPixelAction.h>
#include <geometry_msgs/PointStamped.h>

#include <memory>
#include <optional>
#include <string>

#include "nodes/bus/goal_node.h"
#include "nodes/imaging/hand_setpoints.h"
#include "nodes/imaging/tip_watch.h"
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
class VisualServoNode : public GoalNode<cell_microinjection::GoToPixelAction> {
 public:
  static const char* const kHelp;
  /// @throws ConfigError when a parameter is unknown or out of range.
  explicit VisualServoNode(Bus& bus);

 private:
  struct Parameters {
    std::string calibration;     ///< file, see calibrationPath()
    double input_timeout = 0.5;  ///< s
    ImageApproachConfig approach;

    static Parameters read(const Bus& bus);
  };

  void begin(const Goal& goal) override;
  Result end(bool success) override;
  void step() override;
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) override;

  /// The calibration's file. @throws ConfigError it cannot be read, or is of images of another size (px)
  CameraCalibration readFor(const Eigen::Vector2i& image) const;
  void onProposal(const geometry_msgs::PointStamped& message);
  std::optional<Eigen::Vector3d> proposedPoint() const;  ///< m; none: nothing is proposed, or the place is not known
  void publishProposal();

  Parameters parameters_;
  TipWatch watch_;
  HandSetpoints setpoints_;
  CameraCalibration calibration_;                    ///< of the goal
  Eigen::Vector2d pixel_ = Eigen::Vector2d::Zero();  ///< px, of the goal
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();  ///< m, of the goal
  std::unique_ptr<ImageApproach> approach_;          ///< null: the controller has not engaged yet
  struct Proposal {
    Eigen::Vector2d pixel{0, 0};  ///< px
    ros::SteadyTime received;
    CameraCalibration calibration;
  };
  std::optional<Proposal> proposal_;
  Publisher<geometry_msgs::PointStamped> proposed_point_;
  bool proposal_published_ = false;
  ros::SteadyTime proposal_published_at_;
  Subscription proposed_pixel_;
};

}  // namespace microinjection
