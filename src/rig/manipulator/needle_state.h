#pragma once

#include <string>

#include "base/operating_state.h"
#include "rig/manipulator/manipulator_device.h"

namespace microinjection {

/// CRTK's operating state of the needle: what was commanded, as far as the device and the guards around it allow.
///
/// FAULT while the device or a guard is at fault; DISABLED while the device is not there, a barrier stands or nobody
/// has enabled; else what was commanded. A needle starts enabled and homed: its axes count from a reference. Unhomed it
/// is held until it is homed again.
class NeedleState {
 public:
  /// What no command decides.
  struct Surroundings {
    ManipulatorDevice::State device = ManipulatorDevice::State::kDisconnected;
    bool position_known = false;  ///< by the device
    std::string fault;            ///< of a guard, besides the device's own; empty: none
    std::string barrier;          ///< why the needle may not be enabled now; empty: it may
  };
  /// To be called at each step.
  void surround(const Surroundings& surroundings) { surroundings_ = surroundings; }

  /// Empty when obeyed, otherwise why not: the state is then as before.
  std::string command(StateCommand command);

  OperatingState state() const;
  bool homed() const { return homed_ && surroundings_.position_known; }
  bool disabledByCommand() const { return commanded_ == OperatingState::kDisabled; }
  /// Why motion commands are refused, the device's own reasons apart; else empty.
  std::string unavailableReason() const;

 private:
  Surroundings surroundings_;
  OperatingState commanded_ = OperatingState::kEnabled;
  bool homed_ = true;
};

}  // namespace microinjection
