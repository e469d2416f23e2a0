#pragma once

#include <cell_microinjection/CellEstimate.h>
#include <cell_microinjection/CellParameters.h>
#include <cell_microinjection/CellState.h>
#include <cell_microinjection/InjectionStatus.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/ros.h>

#include <cstdint>
#include <memory>
#include <string>

#include "cell/estimation/cell_estimator.h"
#include "cell/family/family_cell.h"
#include "nodes/runtime/cycle.h"

namespace microinjection {

/// The online twin: finds the modulus of the cell that the needle indents, see CellEstimator, and
/// has cell_simulator serve it.
///
/// In:  /needle/measured_cp, /force_sensor/measured_cf, /controller/injection_state, /cell/state
///      (the sizes of the served cell)
/// Out: /cell/estimate (CellEstimate), /cell/set_parameters (CellParameters)
///
/// Parameters: config/cell_estimator.yaml
class CellEstimatorNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError, also when no family contains the scene's cell
  CellEstimatorNode(ros::NodeHandle node, ros::NodeHandle private_node);
  void run();

 private:
  struct Parameters {
    std::string scene, families;
    double rate = 1000;
    double update_period = 0.02;
    double needle_timeout = 0.05, force_timeout = 0.05, controller_timeout = 0.5;
    double largest_tilt = 0.035;
    double largest_force = 450e-6;
    double clear_distance = 5e-6;
    bool serve = true;
    double serve_period = 0.03;
    double least_change = 0.005, largest_change = 0.15;
    CellEstimatorConfig estimator;
    static Parameters read(const ros::NodeHandle& private_node);
  };

  void makeEstimator();
  void onCell(const cell_microinjection::CellState& message);
  void step(const Cycle::Tick& tick);
  /// Learns from the newest reading. Returns why not; empty if it did.
  std::string learn(const ros::Time& now);
  std::string interruption(const ros::Time& now) const;
  void serve(const ros::Time& now);
  void publish(const ros::Time& now, double update_time);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  Parameters parameters_;
  Scene scene_;  ///< the prior
  FamilyCell member_;
  std::unique_ptr<CellEstimator> estimator_;
  Cycle cycle_;
  Input<geometry_msgs::PoseStamped>& needle_;
  Input<geometry_msgs::WrenchStamped>& force_;
  Input<cell_microinjection::InjectionStatus>& controller_;
  Output<cell_microinjection::CellEstimate>& estimate_;
  Output<cell_microinjection::CellParameters>& change_;
  ros::Subscriber cell_;
  std::string held_;
  ros::Time last_force_, updated_, served_at_;
  double served_ = 0;                   ///< Pa
  bool touched_ = false;                ///< in the present indentation
  bool finished_ = false;               ///< it was punctured: nothing to learn until the needle is clear
  std::uint32_t punctures_before_ = 0;  ///< of the present indentation
};

}  // namespace microinjection
