#include "operation/console/console_parts.h"

#include <sstream>

namespace microinjection {

const char* toText(ConsolePart part) {
  constexpr const char* kWords[] = {"commands", "hand",  "axes",   "devices", "injector",    "automatic", "cell",
                                    "guards",   "score", "sensor", "needle",  "calibration", "plots"};
  return kWords[static_cast<std::size_t>(part)];
}

ConsoleParts ConsoleParts::read(const std::string& words) {
  ConsoleParts parts;
  parts.shown[static_cast<std::size_t>(ConsolePart::kCommands)] = true;
  std::istringstream stream(words);
  for (std::string word; stream >> word;) {
    bool known = false;
    for (const ConsolePart part : kConsoleParts) {
      if (word != toText(part)) continue;
      parts.shown[static_cast<std::size_t>(part)] = known = true;
    }
    if (!known) parts.unknown += (parts.unknown.empty() ? "" : " ") + word;
  }
  return parts;
}

}  // namespace microinjection
