#pragma once

#include <ros/ros.h>

#include <memory>
#include <string>

#include "nodes/haptic/monitored_force.h"
#include "nodes/runtime/master_monitor.h"

namespace microinjection {

/// Publishes zero force on a haptic device's topic at a rate while no other node publishes a force.
/// Drivers may hold the last force for ever, and the bridge or the device's adapter may have been
/// killed.
///
/// In and out: /haptic/servo_cf (WrenchStamped, N), or DEVICE/force_feedback of the driver
///
/// Parameters (private):
///   kind     of the device: crtk, omni or geomagic; default crtk
///   device   namespace of the driver's topics; default that of the adapter
///            (/haptic_device/device); for crtk haptic
///   force    for crtk: topic of the force, below device; default servo_cf
///   from_start  also before another node's first force; default true. false: for an arm that falls
///               at the first force unless it has its settings
///   timeout  s without a force of another node; default 0.05, in (0, inf)
///   rate     Hz, of checks and of zero force; default 200, in [50, 5000]
class ForceWatchdogNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  ForceWatchdogNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  void run();

 private:
  struct Parameters {
    std::string kind = "crtk", device = "haptic", force = "servo_cf";
    bool from_start = true;
    double timeout = 0.05;  // s
    double rate = 200;      // Hz
    static Parameters read(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  };

  const MasterMonitor master_{true};
  Parameters parameters_;
  ros::Time last_received_;  ///< arrival of another node's last force
  std::unique_ptr<MonitoredForce> force_;
};

}  // namespace microinjection
