#include "hardware/injector/femtojet_emulator.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <regex>
#include <utility>

#include "base/errors.h"

namespace microinjection {
namespace {

constexpr char kFaulty[] = "ERR=001";
constexpr double kHectopascal = 100;  // Pa

/// "=" and ten characters with the number right-aligned.
std::string parameter(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "=%10.10g", value);
  return text;
}

}  // namespace

void FemtojetEmulator::process(const std::string& bytes, double time) {
  advance(time);
  std::string text = bytes;
  std::replace(text.begin(), text.end(), '\n', '\r');
  for (const std::string& command : commands_.feed(text)) {
    if (command.empty()) continue;  // the line feed after a carriage return
    const std::string first = config_.echo == FemtojetEmulatorConfig::Echo::kCommand ? command : "";
    const bool two_lines = config_.echo != FemtojetEmulatorConfig::Echo::kNone;
    const std::string reply = (two_lines ? first + config_.line_end : "") + handleCommand(command) + config_.line_end;
    sendAt(time_ + config_.answer_time, reply);
  }
}

std::string FemtojetEmulator::handleCommand(const std::string& line) {
  if (!error_.empty()) return "ERR=" + std::exchange(error_, "");
  static const std::regex form("[Cc]([0-9]{3})(?:=(.{1,10}))?");
  std::smatch groups;
  if (!std::regex_match(line, groups, form)) return kFaulty;
  return groups[2].matched ? enter(groups[1], groups[2]) : execute(groups[1]);
}

std::string FemtojetEmulator::execute(const std::string& number) {
  const std::string reply = "A" + number;
  if (number == "152") return reply + parameter(injection_time_);
  if (number == "153") return reply + parameter(compensation_ / kHectopascal);
  if (number == "154") return reply + parameter(injection_ / kHectopascal);
  if (number != config_.inject || time_ < injects_until_) return kFaulty;
  injects_until_ = time_ + injection_time_;
  return reply;
}

std::string FemtojetEmulator::enter(const std::string& number, const std::string& text) {
  static const std::regex plain("[0-9]+(\\.[0-9]+)?");
  if (!std::regex_match(text, plain)) return kFaulty;
  const double value = std::stod(text);
  const bool is_time = number == "042" || number == "013";
  if (value > (is_time ? config_.longest : config_.highest / kHectopascal)) return kFaulty;
  if (number == "013") {
    cleans_until_ = time_ + value;
  } else if (is_time) {
    injection_time_ = value;
  } else if (number == "043") {
    compensation_ = value * kHectopascal;
  } else if (number == "044") {
    injection_ = value * kHectopascal;
  } else {
    return kFaulty;
  }
  return "A" + number;
}

void FemtojetEmulator::checkError(const std::string& code) const {
  if (code.size() == 3 && std::all_of(code.begin(), code.end(), [](unsigned char c) { return std::isdigit(c); }))
    return;
  throw ConfigError("fault = error:" + code + ": must be three digits");
}

}  // namespace microinjection
