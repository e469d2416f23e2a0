#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/Joy.h>

#include <memory>
#include <optional>
#include <string>

#include "cell_microinjection/StringStamped.h"
#include "nodes/haptic/haptic_registry.h"
#include "nodes/runtime/cycle.h"

namespace microinjection {

/// Connects a haptic device without CRTK topics to the bridge's topics. When the device or the
/// force is stale, and several times before it ends, it renders zero force.
///
/// In:  /haptic/servo_cf (WrenchStamped, N), topics of the device's kind (haptic/KIND_adapter.h)
/// Out: /haptic/measured_cp (PoseStamped, m, frame `haptic`; stamp 0 each 20 ms while the device is
///      stale), /haptic/clutch and /haptic/operator_present (Joy, on change and each 20 ms),
///      /controller/state_command (StringStamped)
///
/// Parameters: see kHelp and config/haptic/
class HapticDeviceNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  explicit HapticDeviceNode(Bus& bus, const std::string& default_kind = "");

 private:
  struct Parameters {
    std::string kind;
    double rate = 1000;
    double force_timeout = 0.05;
    Parameters(ConfigReader& reader, const std::string& default_kind);
  };

  void step(const Cycle::Tick& tick);
  void publishNoMessage(const ros::Time& now);
  void publishButtons(const ros::Time& now, bool clutch, bool operator_present);
  void publishCommands(const ros::Time& now);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void publishZeroForce();

  ConfigReader reader_;
  Parameters parameters_;
  const HapticKind& kind_;
  Cycle cycle_;
  Input<geometry_msgs::WrenchStamped>& force_;
  Output<geometry_msgs::PoseStamped>& position_;
  Output<sensor_msgs::Joy>& clutch_;
  Output<sensor_msgs::Joy>& operator_present_;
  Publisher<cell_microinjection::StringStamped> commands_;
  Subscription controller_;
  bool paused_ = false;  ///< the controller is PAUSED
  std::unique_ptr<HapticAdapter> adapter_;
  std::optional<HandReading> last_;  ///< what was published last
  ros::Time buttons_published_, silence_published_;
};

}  // namespace microinjection
