#pragma once

#include <memory>
#include <string>

#include "nodes/bus/bus.h"
#include "nodes/haptic/monitored_force.h"

namespace microinjection {

/// Publishes zero force on a haptic device's topic at a rate while no other node publishes a force.
/// Drivers may hold the last force for ever, and the bridge or the device's adapter may have been
/// killed.
///
/// In and out: /haptic/servo_cf (WrenchStamped, N), or DEVICE/force_feedback of the driver
///
/// Parameters: see kHelp
class ForceWatchdogNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  explicit ForceWatchdogNode(Bus& bus);

 private:
  struct Parameters {
    std::string kind = "crtk", device, force = "servo_cf";
    bool from_start = true;
    double timeout = 0.05;  // s
    double rate = 200;      // Hz
    static Parameters read(const Bus& bus);
  };

  void check(const ros::Time& now);

  Bus& bus_;
  Parameters parameters_;
  ros::SteadyTime last_received_;  ///< arrival of another node's last force
  std::unique_ptr<MonitoredForce> force_;
};

}  // namespace microinjection
