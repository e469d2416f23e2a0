#include "hardware/manipulator/needle_state.h"

namespace microinjection {

OperatingState NeedleState::state() const {
  using Device = ManipulatorDevice::State;
  if (conditions_.device == Device::kFault || !conditions_.fault.empty()) return OperatingState::kFault;
  const bool there = conditions_.device != Device::kDisconnected && conditions_.barrier.empty();
  return there ? commanded_ : OperatingState::kDisabled;
}

std::string NeedleState::command(StateCommand command) {
  const OperatingState before = state();
  const auto next = after(before, command);
  if (!next) return refusalOf(before, command);
  if (command == StateCommand::kHome) {
    if (!conditions_.position_valid) return "the device does not know its position yet";
    homed_ = true;
  } else if (command == StateCommand::kUnhome) {
    homed_ = false;
  } else {
    commanded_ = *next;
  }
  return "";
}

std::string NeedleState::unavailableReason() const {
  if (!conditions_.fault.empty()) return conditions_.fault + "; allowed after enable";
  if (!conditions_.barrier.empty()) return conditions_.barrier;
  if (commanded_ == OperatingState::kDisabled) return "DISABLED; allowed after enable";
  if (commanded_ == OperatingState::kPaused) return "PAUSED; allowed after resume";
  return homed_ ? "" : "the needle is not homed; allowed after home";
}

}  // namespace microinjection
