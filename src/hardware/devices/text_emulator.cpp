#include "hardware/devices/text_emulator.h"

#include <algorithm>
#include <utility>

#include "base/errors.h"
#include "base/parse_number.h"

namespace microinjection {
namespace {

constexpr std::size_t kLongestCommand = 200;

}  // namespace

void TextEmulator::advance(double time) {
  const double dt = time - time_;
  time_ = std::max(time, time_);
  if (moving_ && dt > 0) move(time, dt);
}

void TextEmulator::process(const std::string& bytes, double time) {
  advance(time);
  for (const char each : bytes) {
    if (each != '\r' && each != '\n') {
      if (command_.size() < kLongestCommand) command_ += each;
      continue;
    }
    const std::string command = std::exchange(command_, "");
    if (command.empty()) continue;
    if (error_ >= 0) {
      reply(error(std::exchange(error_, -1)), time);
    } else {
      handleCommand(command, time);
    }
  }
}

void TextEmulator::checkError(const std::string& code) const {
  const auto number = parseNumber<int>(code);
  if (code == kReset || (number && *number >= 0 && *number <= 999)) return;
  throw ConfigError("fault = error:" + code + ": must be a number from 0 to 999, or RESET");
}

void TextEmulator::failNextCommand(const std::string& code) {
  if (code != kReset) {
    error_ = std::stoi(code);
    return;
  }
  command_.clear();
  dropReplies();
  error_ = -1;
  moving_ = false;
  switchOn();
}

}  // namespace microinjection
