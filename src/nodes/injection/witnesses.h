#pragma once

#include <geometry_msgs/WrenchStamped.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "cell_microinjection/CellContact.h"
#include "cell_microinjection/CellParameters.h"
#include "cell_microinjection/VisionState.h"
#include "nodes/runtime/force_liveness.h"
#include "nodes/runtime/receipt.h"
#include "operation/control/injection_controller.h"

namespace microinjection {

/// What the controller hears of the cell beside the force that it acts on. A witness that nobody sends is none; one
/// that two nodes send, or that repeats itself, is a reason not to go on.
///
/// In: /force_sensor/measured_cf or /cell/predicted_cf (WrenchStamped, the one that force_source does not name),
///     /cell/parameters (CellParameters, after the served cell has changed), /vision/state (VisionState), with
///     force_source predicted also /cell/contact (CellContact, is the cell punctured?)
class Witnesses {
 public:
  /// @param force_source  predicted or measured, of the force that the controller acts on
  /// @param timeout       s, of the other force
  /// @param quiet_sensor  of the session, sensor/quiet
  Witnesses(Cycle& cycle, const std::string& force_source, double timeout, bool quiet_sensor);

  /// `needle`: its pose, whose axes a force in needle_tip has.
  void fill(const Eigen::Isometry3d& needle, const ros::Time& now, InjectionController::Input& input);

 private:
  void receiveChange(const cell_microinjection::CellParameters& message, const ros::Time& received);
  void receiveImage(const cell_microinjection::VisionState& message);
  std::string fault(const ros::Time& now) const;

  Bus& bus_;
  Input<geometry_msgs::WrenchStamped>& force_;
  ForceLiveness force_lives_;
  ros::Time changed_;    ///< arrival of a change that makes the force fall suddenly
  double modulus_ = -1;  ///< Pa, largest one served since then; negative: none is known
  ros::Time cell_received_;
  bool can_be_punctured_ = false, inside_ = false;
  std::optional<double> gap_;  ///< m, of the newest image, see InjectionController::Image; empty: it does not show that
  ros::Time exposed_;          ///< stamp of that image
  Receipt image_;
  Subscription changes_, cell_, images_;
};

}  // namespace microinjection
