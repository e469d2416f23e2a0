#pragma once

#include <string>

#include "base/operating_state.h"
#include "hardware/manipulator/manipulator_device.h"

namespace microinjection {

/// CRTK operating state of the needle: the commanded state, restricted by the device and the
/// guards.
///
/// FAULT: the device or a guard has a fault. DISABLED: the device is not connected, a barrier
/// exists, or DISABLED was commanded. Otherwise the commanded state. A needle starts enabled and
/// homed, since its axes have a reference. While it is not homed, it is held.
class NeedleState {
 public:
  /// Conditions that do not depend on commands.
  struct Conditions {
    ManipulatorDevice::State device = ManipulatorDevice::State::kDisconnected;
    bool position_valid = false;  ///< by the device
    std::string fault;            ///< of a guard, in addition to the device's; empty: none
    std::string barrier;          ///< why the needle may not be enabled; empty: it may
  };
  /// Must be called in each step.
  void setConditions(const Conditions& conditions) { conditions_ = conditions; }

  /// Returns an empty text if executed, otherwise the reason; the state is then unchanged.
  std::string command(StateCommand command);

  OperatingState state() const;
  bool homed() const { return homed_ && conditions_.position_valid; }
  bool disabledByCommand() const { return commanded_ == OperatingState::kDisabled; }
  /// The reason why motion commands are refused, except for the device's own reasons; else empty.
  std::string unavailableReason() const;

 private:
  Conditions conditions_;
  OperatingState commanded_ = OperatingState::kEnabled;
  bool homed_ = true;
};

}  // namespace microinjection
