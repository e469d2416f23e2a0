#include "hardware/devices/eppendorf/eppendorf_protocol.h"

#include <regex>

namespace microinjection {
namespace {

std::string goToLine(const std::string& command, const std::array<long, 3>& position,
                     const std::array<int, 3>& speeds) {
  std::string line = command;
  for (const long each : position) line += " " + std::to_string(each);
  for (const int each : speeds) line += " " + std::to_string(each);
  return line;
}

}  // namespace

std::string eppendorfRemote() { return "C004"; }
std::string eppendorfManual() { return "C005"; }
std::string eppendorfStop() { return "C008"; }
std::string eppendorfPosition(EppendorfUnit unit) { return unit == EppendorfUnit::kMicrostep ? "C009" : "C010"; }

std::string eppendorfGoTo(const std::array<long, 3>& position, const std::array<int, 3>& speeds) {
  return goToLine("C012", position, speeds);
}

std::string eppendorfGoToMicrosteps(const std::array<long, 3>& position, const std::array<int, 3>& speeds) {
  return goToLine("C006", position, speeds) + "\r" + eppendorfPosition(EppendorfUnit::kMicrostep);
}

bool isEppendorfMoveEnd(const std::string& bytes) {
  static const std::regex form("\n?A006 +\\d{1,4}\r");
  return std::regex_match(bytes, form);
}

bool mayBeEppendorfMoveEnd(const std::string& bytes) {
  static const std::regex form("\n?(A(0(0(6( *( \\d{1,4})?)?)?)?)?)?");
  return std::regex_match(bytes, form);
}

bool isEppendorfReply(const std::string& reply, const std::string& command) {
  return reply == "A" + command.substr(1, 3);
}

std::optional<EppendorfPosition> readEppendorfPosition(const std::string& reply, EppendorfUnit unit) {
  // A sign separates numbers as a space does. Nine digits exceed any travel, and fit.
  static const std::string number = R"((?: +([+-]?)|([+-]))(\d{1,9}(?:\.\d{1,6})?))";
  static const std::regex form("A(009|010)" + number + number + number + R"( +(\d{1,4}))");
  std::smatch found;
  if (!std::regex_match(reply, found, form) || found[1] != eppendorfPosition(unit).substr(1)) return std::nullopt;
  EppendorfPosition position;
  for (int i = 0; i < 3; ++i) {
    const std::string sign = found[3 * i + 2].str() + found[3 * i + 3].str();
    position.coordinates[i] = std::stod(found[3 * i + 4]) * (sign == "-" ? -1 : 1);
  }
  position.limits = std::stoi(found[11]);
  return position;
}

}  // namespace microinjection
