#pragma once

#include <cell_microinjection/CellContact.h>
#include <cell_microinjection/InjectionStatus.h>
#include <cell_microinjection/OperatingState.h>
#include <cell_microinjection/VisionState.h>
#include <geometry_msgs/PoseStamped.h>

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "nodes/bus/bus.h"
#include "nodes/runtime/awake_time.h"
#include "nodes/runtime/receipt.h"
#include "vision/calibration/calibration_run.h"

namespace microinjection {

/// What is known of the needle: its position by the manipulator, its tip in the newest image, and the
/// operating states of needle and controller.
class TipWatch {
 public:
  /// `timeout` (s): older values count as unknown.
  TipWatch(Bus& bus, double timeout);

  std::optional<Eigen::Vector3d> position() const;  ///< m, `world`; none: silent or invalid
  /// A pose of the needle at another position (m), with the measured orientation.
  Eigen::Isometry3d poseAt(const Eigen::Vector3d& position) const {
    return Eigen::Translation3d(position) * orientation_;
  }
  std::optional<SeenTip> tip() const;  ///< none: not found in the newest image, or that is old
  /// Why there is no tip.
  std::string tipReason() const { return tip_ ? "the image is old" : tip_reason_; }
  /// s of ROS time, since when the needle has been at one place within 0.2 um.
  double restedSince() const { return rested_; }
  Eigen::Vector2i imageSize() const { return image_size_; }  ///< px, width and height
  Eigen::Vector2d imageCentre() const { return (image_size_.cast<double>() - Eigen::Vector2d::Ones()) / 2; }  ///< px
  const cell_microinjection::OperatingState& needle() const { return needle_state_; }
  const cell_microinjection::OperatingState& controller() const { return controller_state_; }

  /// Why the needle must not be moved across: it touches the cell or is in it, by the controller, by
  /// cell_simulator or by the image. Empty: it is clear above the cell, as far as is known.
  std::string cellInTheWay() const;
  /// Why the tip must not go straight to a pixel: the way is through the cell, by the newest image. Empty:
  /// it is not, or the cell or the tip was not found.
  std::string cellOnTheWay(const Eigen::Vector2d& pixel) const;

  /// Called when the needle has moved to another place (m). `followed`: it was watched all the way.
  std::function<void(const Eigen::Vector3d&, bool followed)> on_motion;
  /// Called for each image in which the tip was found.
  std::function<void(const SeenTip&)> on_tip;

 private:
  void onNeedle(const geometry_msgs::PoseStamped& message);
  void onVision(const cell_microinjection::VisionState& message);
  Receipt receive(const ros::Time& stamp) const { return {stamp, bus_.steady()}; }
  bool isOld(const Receipt& receipt) const { return receipt.isOld(timeout_, bus_.now(), bus_.steady()); }

  Bus& bus_;
  double timeout_;
  std::optional<Eigen::Vector3d> position_;
  Eigen::Quaterniond orientation_ = Eigen::Quaterniond::Identity();
  Receipt position_receipt_, tip_receipt_;
  Eigen::Vector3d resting_place_ = Eigen::Vector3d::Zero();  ///< m
  double rested_ = 0;
  std::optional<SeenTip> tip_;
  std::string tip_reason_ = "no image was received";
  Eigen::Vector2i image_size_ = Eigen::Vector2i::Zero();
  std::string beside_;  ///< by the newest image: why the tip is not clear above the cell; else empty
  struct SeenCell {
    Eigen::Vector2d centre{0, 0};  ///< px
    double radius = 0;             ///< px
  };
  std::optional<SeenCell> cell_;            ///< in the newest image that shows one
  bool touches_ = false, injects_ = false;  ///< by cell_simulator and by the controller
  /// When a message arrived: s of awake_, below 0: never; and of steady time.
  struct Heard {
    double awake = -1;
    ros::SteadyTime time;
  };
  Heard touch_heard_, injection_heard_;
  AwakeTime awake_;
  cell_microinjection::OperatingState needle_state_, controller_state_;
  std::vector<Subscription> subscriptions_;
  BusHandle timer_;
};

}  // namespace microinjection
