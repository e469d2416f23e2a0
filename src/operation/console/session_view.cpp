#include "operation/console/session_view.h"

namespace microinjection {

std::optional<OperatingState> operatingStateOf(const std::string& text) {
  for (const OperatingState state :
       {OperatingState::kDisabled, OperatingState::kEnabled, OperatingState::kPaused, OperatingState::kFault}) {
    if (text == toText(state)) return state;
  }
  return std::nullopt;
}

}  // namespace microinjection
