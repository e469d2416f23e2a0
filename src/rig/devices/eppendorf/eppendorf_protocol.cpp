#include "rig/devices/eppendorf/eppendorf_protocol.h"

#include <regex>

namespace microinjection {

std::string eppendorfRemote() { return "C004"; }
std::string eppendorfManual() { return "C005"; }
std::string eppendorfStop() { return "C008"; }
std::string eppendorfPosition() { return "C010"; }

std::string eppendorfGoTo(const std::array<long, 3>& position, const std::array<int, 3>& speeds) {
  std::string line = "C012";
  for (const long each : position) line += " " + std::to_string(each);
  for (const int each : speeds) line += " " + std::to_string(each);
  return line;
}

bool isEppendorfReply(const std::string& reply, const std::string& command) {
  return reply == "A" + command.substr(1, 3);
}

std::optional<EppendorfPosition> readEppendorfPosition(const std::string& reply) {
  // A sign separates numbers as a space does. Nine digits exceed any travel, and fit.
  static const std::string number = R"((?: +([+-]?)|([+-]))(\d{1,9}(?:\.\d{1,6})?))";
  static const std::regex form("A010" + number + number + number + R"( +(\d{1,4}))");
  std::smatch found;
  if (!std::regex_match(reply, found, form)) return std::nullopt;
  EppendorfPosition position;
  for (int i = 0; i < 3; ++i) {
    const std::string sign = found[3 * i + 1].str() + found[3 * i + 2].str();
    position.coordinates[i] = std::stod(found[3 * i + 3]) * (sign == "-" ? -1 : 1);
  }
  position.limits = std::stoi(found[10]);
  return position;
}

}  // namespace microinjection
