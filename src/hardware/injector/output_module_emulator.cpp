#include "hardware/injector/output_module_emulator.h"

#include <cstdio>
#include <regex>
#include <utility>

#include "base/errors.h"

namespace microinjection {
namespace {

constexpr unsigned kRelays = 4;
constexpr double kHighest = 10;  // V

}  // namespace

double OutputModuleEmulator::pressure() const {
  if (config_.kind == OutputModuleConfig::Kind::kVoltage) return volts_ * config_.pressure_per_volt;
  return relays_ & 1u ? config_.supply : config_.balance;
}

void OutputModuleEmulator::process(const std::string& bytes, double time) {
  for (const std::string& command : commands_.feed(bytes)) {
    const std::string reply = handleCommand(command);
    if (!reply.empty()) sendAt(time + config_.answer_time, reply + "\r");
  }
}

std::string OutputModuleEmulator::handleCommand(const std::string& command) {
  const bool well_formed = command.size() > 3 && (command[0] == '#' || command[0] == '$');
  if (!well_formed || command.substr(1, 2) != config_.address) return "";
  const std::string invalid = "?" + config_.address, data = command.substr(3);
  if (std::exchange(fails_, false)) return invalid;
  if (command[0] == '$') return data == "6" ? readBack() : invalid;
  return (config_.kind == OutputModuleConfig::Kind::kRelays ? setRelays(data) : setVoltage(data)) ? ">" : invalid;
}

bool OutputModuleEmulator::setRelays(const std::string& data) {
  static const std::regex one("1([0-3])0([01])"), all("000([0-9A-F])");
  std::smatch groups;
  if (std::regex_match(data, groups, one)) {
    const unsigned bit = 1u << static_cast<unsigned>(std::stoi(groups[1]));
    relays_ = groups[2] == "1" ? relays_ | bit : relays_ & ~bit;
    return true;
  }
  if (!std::regex_match(data, groups, all)) return false;
  relays_ = static_cast<unsigned>(std::stoi(groups[1], nullptr, 16)) & ((1u << kRelays) - 1);
  return true;
}

bool OutputModuleEmulator::setVoltage(const std::string& data) {
  static const std::regex form("[0-9]{2}\\.[0-9]{3}");
  if (!std::regex_match(data, form) || std::stod(data) > kHighest) return false;
  volts_ = std::stod(data);
  return true;
}

std::string OutputModuleEmulator::readBack() const {
  char text[32];
  if (config_.kind == OutputModuleConfig::Kind::kRelays) {
    std::snprintf(text, sizeof text, "!%02X0000", relays_);
  } else {
    std::snprintf(text, sizeof text, "!%s%06.3f", config_.address.c_str(), volts_);
  }
  return text;
}

void OutputModuleEmulator::checkError(const std::string& code) const {
  if (code != "?") throw ConfigError("fault = error:" + code + ": must be ?");
}

}  // namespace microinjection
