#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/Joy.h>

#include <string>
#include <vector>

#include "cell_microinjection/OperatingState.h"
#include "nodes/haptic/device_settings.h"
#include "nodes/haptic/force_receiver.h"
#include "nodes/haptic/haptic_adapter.h"

namespace microinjection {

/// A button of a driver: a topic of sensor_msgs/Joy and an index.
struct CrtkButton {
  std::string topic;  ///< below the device's namespace, or absolute; empty: the device has none
  int index = 0;      ///< in `buttons`

  static CrtkButton read(ConfigReader reader, const std::string& topic);
};

struct CrtkConfig {
  std::string device = "haptic";       ///< namespace of the driver's topics
  std::string position_type = "pose";  ///< pose (PoseStamped) or transform (TransformStamped, before 2022)
  std::string force = "servo_cf";      ///< topic of the force on the hand
  std::string state;            ///< topic of its OperatingState, which must be ENABLED and homed; empty: not checked
  double timeout = 0.1;         ///< s, past which the device is stale
  double button_timeout = 0;    ///< s; 0: a button's last state is valid until the device is stale
  CrtkButton clutch;            ///< held down: the hand moves without the needle
  CrtkButton operator_present;  ///< held down: the operator is present; none: always
  std::vector<DeviceSetting> settings;  ///< published to the driver before any force

  static CrtkConfig read(ConfigReader& reader);
};

/// A device whose driver uses CRTK but differs from the bridge's topics: force on another topic,
/// several buttons in a Joy, switches to set first, an operating state required for forces, or
/// positions as transforms. In: DEVICE/measured_cp, state and buttons. Out: force and settings. All
/// are in the driver's axes; the bridge's device_axes rotates them. A tapped button (2 or 3 with
/// cisst's drivers) is not held down.
class CrtkAdapter : public HapticAdapter {
 public:
  using Config = CrtkConfig;
  CrtkAdapter(Cycle& cycle, const CrtkConfig& config);

  std::optional<HandReading> read(const Cycle::Tick& tick) override;
  void render(const Eigen::Vector3d& force, const Cycle::Tick& tick) override;
  std::string invalidReason() const override { return reason_; }

 private:
  struct Position {
    ros::Time stamp;
    std::string frame;
    Eigen::Vector3d position;  // m
  };
  std::optional<Position> position(const ros::Time& now) const;
  /// Why the device does not render the force; empty: it does.
  std::string noForceReason(const ros::Time& now);
  Input<sensor_msgs::Joy>* subscribe(Cycle& cycle, const CrtkButton& button) const;

  CrtkConfig config_;
  Input<geometry_msgs::PoseStamped>* pose_ = nullptr;            ///< null: positions are transforms
  Input<geometry_msgs::TransformStamped>* transform_ = nullptr;  ///< null: they are poses
  Input<cell_microinjection::OperatingState>* state_ = nullptr;  ///< null: not checked
  Input<sensor_msgs::Joy>* clutch_;                              ///< null: none
  Input<sensor_msgs::Joy>* operator_present_;                    ///< null: none
  Output<geometry_msgs::WrenchStamped>& force_;
  DeviceSettings settings_;
  ForceReceiver receiver_;
  bool ready_ = false;  ///< the driver has its settings
  std::string frame_;   ///< of the last position
  std::string reason_;
};

}  // namespace microinjection
