#include "rig/manipulator/needle_state.h"

namespace microinjection {

OperatingState NeedleState::state() const {
  using Device = ManipulatorDevice::State;
  if (surroundings_.device == Device::kFault || !surroundings_.fault.empty()) return OperatingState::kFault;
  const bool there = surroundings_.device != Device::kDisconnected && surroundings_.barrier.empty();
  return there ? commanded_ : OperatingState::kDisabled;
}

std::string NeedleState::command(StateCommand command) {
  const OperatingState before = state();
  const auto next = after(before, command);
  if (!next) return refusalOf(before, command);
  if (command == StateCommand::kHome) {
    if (!surroundings_.position_known) return "the device does not know its position yet";
    homed_ = true;
  } else if (command == StateCommand::kUnhome) {
    homed_ = false;
  } else {
    commanded_ = *next;
  }
  return "";
}

std::string NeedleState::unavailableReason() const {
  if (!surroundings_.fault.empty()) return surroundings_.fault + "; allowed after enable";
  if (!surroundings_.barrier.empty()) return surroundings_.barrier;
  if (commanded_ == OperatingState::kDisabled) return "DISABLED; allowed after enable";
  if (commanded_ == OperatingState::kPaused) return "PAUSED; allowed after resume";
  return homed_ ? "" : "the needle is not homed; allowed after home";
}

}  // namespace microinjection
