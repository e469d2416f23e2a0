#pragma once

#include <string>

#include "nodes/haptic/force_receiver.h"
#include "nodes/haptic/haptic_adapter.h"
#include "nodes/haptic/omni_messages.h"

namespace microinjection {

struct OmniConfig {
  std::string device = "phantom";         ///< namespace of the driver's topics
  double length_unit = 1e-3;              ///< m, of the driver's positions
  double timeout = 0.05;                  ///< s, past which the device is silent
  std::string clutch_button = "grey";     ///< grey, white or none
  std::string operator_button = "white";  ///< grey, white or none; held down: the operator is present

  static OmniConfig read(ConfigReader& reader);
};

/// phantom_omni (Touch, Omni): DEVICE/state and DEVICE/button in, DEVICE/force_feedback out. Position and force have
/// the axes (X, -Z, Y) of OpenHaptics: x right, y away, z up. The state's `locked` and `close_gripper` are not read:
/// the driver turns the one over at each press of the white button, the other at each of the grey one, and does nothing
/// by them. Buttons are told on change only and hold until they change; where the device falls silent the operator is
/// gone until the button is pressed again.
class OmniAdapter : public HapticAdapter {
 public:
  using Config = OmniConfig;
  OmniAdapter(Cycle& cycle, const OmniConfig& config);

  std::optional<HandReading> read(const Cycle::Tick& tick) override;
  void render(const Eigen::Vector3d& force, const Cycle::Tick& tick) override;
  std::string whySilent() const override { return receiver_.why(); }

 private:
  OmniConfig config_;
  Input<OmniState>& state_;
  ros::Subscriber buttons_;
  ros::Publisher force_;
  ForceReceiver receiver_;
  bool clutch_ = false;
  bool operator_present_ = false;
};

}  // namespace microinjection
