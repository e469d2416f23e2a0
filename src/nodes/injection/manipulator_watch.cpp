#include "nodes/injection/manipulator_watch.h"

#include <utility>

#include "base/operating_state.h"
#include "cell_microinjection/LoopState.h"
#include "cell_microinjection/OperatingState.h"
#include "nodes/runtime/message_guard.h"

namespace microinjection {

ManipulatorWatch::ManipulatorWatch(Bus& bus) {
  using cell_microinjection::LoopState;
  using cell_microinjection::OperatingState;
  operating_states_ = subscribeGuarded<OperatingState>(
      bus, "needle/operating_state", 10, [this](const OperatingState& message, const std::string&) {
        const bool enabled = message.state == toText(microinjection::OperatingState::kEnabled);
        state_ = enabled ? "" : "the micromanipulator is " + message.state;
        if (!enabled) missed_ = state_;
      });
  loop_states_ =
      subscribeGuarded<LoopState>(bus, "needle/loop_state", 10, [this](const LoopState& message, const std::string&) {
        loop_ = message.follows ? "" : "the micromanipulator holds: " + message.hold_reason;
        if (!message.follows) missed_ = loop_;
      });
}

std::string ManipulatorWatch::takeHold() {
  const std::string missed = std::exchange(missed_, "");
  if (!state_.empty()) return state_;
  return loop_.empty() ? missed : loop_;
}

}  // namespace microinjection
