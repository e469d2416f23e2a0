#include "hardware/injector/arduino_emulator.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include "base/errors.h"

namespace microinjection {
namespace {

constexpr std::size_t kBuffer = 63;                                        // bytes that an Uno keeps
constexpr double kPurgeOpens = 0.2, kPurgeCloses = 0.7, kPurgeEnds = 1.1;  // s

}  // namespace

double ArduinoEmulator::pressure() const {
  const double purging = time_ - purge_;
  if (purging < kPurgeEnds) return purging >= kPurgeOpens && purging < kPurgeCloses ? config_.supply : 0;
  return time_ < low_open_until_ ? pwm_ * config_.pressure_per_count : 0;
}

void ArduinoEmulator::process(const std::string& bytes, double time) {
  advance(time);
  if (time < deaf_until_) return;
  for (const char byte : bytes) {
    if (time_ >= next_ && !reading_ && received_.empty()) next_ = time_ + config_.byte_time, reading_ = true;
    if (received_.size() < kBuffer) received_.push_back(byte);
  }
}

void ArduinoEmulator::advance(double time) {
  while (next_ <= time && !received_.empty()) {
    const double now = next_;
    if (std::exchange(reading_, true)) {
      command_ += received_.front();
      received_.pop_front();
    }
    next_ = now + config_.byte_time;
    if (received_.empty()) handleCommand(now);
  }
  time_ = std::max(time, time_);
}

/// Ends with the time from which the next command is read.
void ArduinoEmulator::handleCommand(double time) {
  reading_ = false;
  if (std::exchange(loses_first_, false)) command_.erase(0, 1);
  next_ = time + config_.pause;
  if (!command_.empty()) sendAt(time, "Arduino recieved: " + command_ + "\r\n");
  if (command_[0] == 'b') setPressure(time);
  if (command_[0] == 'x') {
    purge_ = time;
    next_ += kPurgeEnds;
  }
  command_.clear();
}

/// As Arduino's String does it: a missing letter is at -1, exchanged ends are put in order, and a
/// text that is no number is 0. An int has 16 bits, and the output uses eight of them.
void ArduinoEmulator::setPressure(double time) {
  std::size_t from = command_.find('c') + 1, to = command_.find('C');
  if (from > to) std::swap(from, to);
  const std::string text = from < command_.size() ? command_.substr(from, to - from) : "";
  const auto number = static_cast<std::int16_t>(std::strtol(text.c_str(), nullptr, 10));
  pwm_ = number & 0xFF;
  if (number > 0) {
    low_open_until_ = kNever;
  } else {
    low_open_until_ = std::min(low_open_until_, time + config_.vent_time);
    next_ += config_.vent_time;
  }
}

void ArduinoEmulator::checkError(const std::string& code) const {
  if (code != "?") throw ConfigError("fault = error:" + code + ": must be ?");
}

void ArduinoEmulator::interrupt(double time) {
  received_.clear();
  command_.clear();
  dropReplies();
  reading_ = false;
  pwm_ = 0;
  low_open_until_ = 0;
  purge_ = -kNever;
  next_ = time + config_.boot_time;
  deaf_until_ = next_;
}

}  // namespace microinjection
