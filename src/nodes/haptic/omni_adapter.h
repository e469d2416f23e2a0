#pragma once

#include <string>

#include "nodes/haptic/force_receiver.h"
#include "nodes/haptic/haptic_adapter.h"
#include "nodes/haptic/omni_messages.h"
#include "nodes/runtime/sole_sender.h"

namespace microinjection {

struct OmniConfig {
  std::string device = "phantom";         ///< namespace of the driver's topics
  double length_unit = 1e-3;              ///< m, of the driver's positions
  double timeout = 0.05;                  ///< s, past which the device is stale
  std::string clutch_button = "grey";     ///< grey, white or none
  std::string operator_button = "white";  ///< grey, white or none; held down: the operator is present

  static OmniConfig read(ConfigReader& reader);
};

/// phantom_omni (Touch, Omni): DEVICE/state and DEVICE/button in, DEVICE/force_feedback out.
/// Position and force have the axes (X, -Z, Y) of OpenHaptics: x right, y away, z up. The state's
/// `locked` and `close_gripper` are not used: the driver toggles them at each press of the white
/// and the grey button, without effect. Buttons are published on change only and valid until they
/// change. After the device was stale the operator is absent until the next press.
class OmniAdapter : public HapticAdapter {
 public:
  using Config = OmniConfig;
  OmniAdapter(Cycle& cycle, const OmniConfig& config);

  std::optional<HandReading> read(const Cycle::Tick& tick) override;
  void render(const Eigen::Vector3d& force, const Cycle::Tick& tick) override;
  std::string invalidReason() const override { return rivals_.empty() ? receiver_.reason() : rivals_; }

 private:
  OmniConfig config_;
  Input<OmniState>& state_;
  Subscription buttons_;
  Publisher<OmniFeedback> force_;
  ForceReceiver receiver_;
  SoleSender button_senders_;
  std::string rivals_;  ///< why the buttons do not count; empty: they do
  bool clutch_ = false;
  bool operator_present_ = false;
};

}  // namespace microinjection
