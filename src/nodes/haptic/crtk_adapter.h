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

/// A button of a driver's: a topic of sensor_msgs/Joy and its place there.
struct CrtkButton {
  std::string topic;  ///< below the device's namespace, or absolute; empty: the device has none
  int index = 0;      ///< of `buttons`

  static CrtkButton read(ConfigReader reader, const std::string& topic);
};

struct CrtkConfig {
  std::string device = "haptic";        ///< namespace of the driver's topics
  std::string position_type = "pose";   ///< pose (PoseStamped) or transform (TransformStamped, before 2022)
  std::string force = "servo_cf";       ///< topic of the force on the hand
  std::string state;                    ///< topic of its OperatingState, to be ENABLED and homed; empty: not asked for
  double timeout = 0.1;                 ///< s, past which the device is silent
  double button_timeout = 0;            ///< s; 0: what a button said last holds until the device was silent
  CrtkButton clutch;                    ///< held down: the hand moves alone
  CrtkButton operator_present;          ///< held down: the operator is present; none: always
  std::vector<DeviceSetting> settings;  ///< what the driver is told first

  static CrtkConfig read(ConfigReader& reader);
};

/// A device whose driver speaks CRTK but not all as the bridge does: force on another topic, buttons of a Joy with
/// several, switches to be set first, a state in which alone it renders forces, or positions as transforms.
/// DEVICE/measured_cp, state and buttons in, force and settings out, in the axes of the driver, which the bridge's
/// device_axes turns. A button that was tapped (2 or 3 with cisst's drivers) is not held down.
class CrtkAdapter : public HapticAdapter {
 public:
  using Config = CrtkConfig;
  CrtkAdapter(Cycle& cycle, const CrtkConfig& config);

  std::optional<HandReading> read(const Cycle::Tick& tick) override;
  void render(const Eigen::Vector3d& force, const Cycle::Tick& tick) override;
  std::string whySilent() const override { return reason_; }

 private:
  struct Position {
    ros::Time stamp;
    std::string frame;
    Eigen::Vector3d position;  // m
  };
  std::optional<Position> position(const ros::Time& now) const;
  /// Why the device would not render a force; empty: it would.
  std::string whyUnfelt(const ros::Time& now);
  Input<sensor_msgs::Joy>* listenTo(Cycle& cycle, const CrtkButton& button) const;

  CrtkConfig config_;
  bool lockstep_;
  Input<geometry_msgs::PoseStamped>* pose_ = nullptr;            ///< null: positions are transforms
  Input<geometry_msgs::TransformStamped>* transform_ = nullptr;  ///< null: they are poses
  Input<cell_microinjection::OperatingState>* state_ = nullptr;  ///< null: not asked for
  Input<sensor_msgs::Joy>* clutch_;                              ///< null: none
  Input<sensor_msgs::Joy>* operator_present_;                    ///< null: none
  Output<geometry_msgs::WrenchStamped>& force_;
  DeviceSettings settings_;
  ForceReceiver receiver_;
  bool ready_ = false;  ///< the driver knows its settings
  std::string frame_;   ///< of the last position
  std::string reason_;
};

}  // namespace microinjection
