#pragma once

#include <geometry_msgs/WrenchStamped.h>

#include <Eigen/Geometry>
#include <string>

#include "cell_microinjection/CellParameters.h"
#include "cell_microinjection/CellState.h"
#include "nodes/bus/bus.h"
#include "operation/control/injection_controller.h"

namespace microinjection {

/// What the controller hears of the cell beside the force that it acts on.
///
/// In: /force_sensor/measured_cf or /cell/predicted_cf (WrenchStamped, the one that force_source does not name),
///     /cell/parameters (CellParameters, after the served cell has changed), with force_source predicted also
///     /cell/state (CellState, is the cell punctured?)
class Witnesses {
 public:
  /// @param force_source  predicted or measured, of the force that the controller acts on
  /// @param timeout       s, of the other force
  Witnesses(Bus& bus, const std::string& force_source, double timeout);

  /// `needle`: its pose, whose axes a force in needle_tip has.
  void fill(const Eigen::Isometry3d& needle, const ros::Time& now, InjectionController::Input& input);

 private:
  void receiveChange(const cell_microinjection::CellParameters& message, const ros::Time& received);

  double timeout_;
  boost::shared_ptr<const geometry_msgs::WrenchStamped> force_;
  ros::Time changed_;    ///< arrival of a change that makes the force fall suddenly
  double modulus_ = -1;  ///< Pa, largest one served since then; negative: none is known
  ros::Time cell_received_;
  bool can_be_punctured_ = false, inside_ = false;
  Subscription force_topic_, changes_, cell_;
};

}  // namespace microinjection
