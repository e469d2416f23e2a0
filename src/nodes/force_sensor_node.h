#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/ros.h>

#include <string>

#include "nodes/cycle.h"
#include "sensor/force_sensor.h"

namespace microinjection {

/// A virtual two-axis MEMS force sensor at the pipette: along it (force.z) and across it (force.x), in `needle_tip`.
///
/// In:  /cell/predicted_cf (WrenchStamped, `world`), /needle/measured_cp (PoseStamped, for the pipette's axes)
/// Out: /force_sensor/measured_cf (WrenchStamped, `needle_tip`; stamp 0 when there is no trusted force to sense)
///
/// Parameters (private): those of ForceSensorConfig and
///   rate           Hz; default 1000, in [50, 5000]
///   input_timeout  s, past which an input is stale; default 0.05, in (0, inf)
class ForceSensorNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  ForceSensorNode(ros::NodeHandle node, ros::NodeHandle private_node);
  void run();

 private:
  struct Parameters {
    double rate = 1000;
    double input_timeout = 0.05;
    ForceSensorConfig model;
    static Parameters read(const ros::NodeHandle& private_node);
  };

  void step(const Cycle::Tick& tick);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  Parameters parameters_;
  ForceSensor model_;
  Cycle cycle_;
  Input<geometry_msgs::WrenchStamped>& force_;
  Input<geometry_msgs::PoseStamped>& needle_;
  Output<geometry_msgs::WrenchStamped>& measured_;
  std::string untrusted_;  ///< why there is no reading; else empty
};

}  // namespace microinjection
