#include "hardware/devices/sensapex/sensapex_emulator.h"

#include <algorithm>
#include <utility>

#include "base/errors.h"
#include "base/parse_number.h"

namespace microinjection {
namespace {

// Of smcp1.h.
constexpr unsigned kVersion10 = 0x10, kInt32 = 6, kUint32 = 5, kEverybody = 0x7ff, kAllManipulators = 0xff;
constexpr unsigned kOptRequest = 1, kOptAck = 2, kOptNotify = 4, kOptError = 8, kOptReqAck = 0x10, kOptReqResp = 0x20,
                   kOptReqNotify = 0x40;
constexpr unsigned kCmdPing = 0, kCmdStop = 1, kCmdPositions = 14, kCmdParameter = 16, kCmdVersion = 23, kCmdGoto = 33,
                   kNotifyHello = 100, kNotifyGotoDone = 104;
constexpr std::int32_t kParamAxisCount = 0x105, kArgUndef = INT32_MAX;
constexpr double kOneDatagram = 5e-3;  // s; bytes that come later are of another

unsigned field(const std::string& bytes, std::size_t at, int size) {
  unsigned value = 0;
  for (int i = 0; i < size; ++i)
    value = value * 256 + static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]);
  return value;
}

std::string asBytes(unsigned value, int size) {
  std::string bytes(static_cast<std::size_t>(size), '\0');
  for (int i = size - 1; i >= 0; --i, value /= 256) bytes[static_cast<std::size_t>(i)] = static_cast<char>(value % 256);
  return bytes;
}

/// nm/s; libum sends speeds below 1 um/s as negative nm/s.
double speedOf(std::int32_t argument) { return argument > 0 ? argument * 1e3 : -static_cast<double>(argument); }

}  // namespace

void SensapexEmulator::process(const std::string& bytes, double time) {
  advance(time);
  if (time - last_byte_ > kOneDatagram) received_.clear();
  last_byte_ = time;
  for (const char each : bytes) {
    received_ += each;
    const std::size_t size = messageSize();
    if (size == 0 || received_.size() < size) continue;
    const Request request = take(size);
    handle(request, time);
  }
}

/// 0: its headers are not whole yet. What is not for this device is dropped.
std::size_t SensapexEmulator::messageSize() const {
  if (received_.size() < 16) return 0;
  std::size_t at = 16;
  for (unsigned blocks = field(received_, 14, 2); blocks > 0; --blocks) {
    if (received_.size() < at + 4) return 0;
    at += 4 + 4 * field(received_, at + 2, 2);
  }
  return at;
}

SensapexEmulator::Request SensapexEmulator::take(std::size_t size) {
  const std::string bytes = received_.substr(0, size);
  received_.clear();
  Request request;
  const unsigned receiver = field(bytes, 2, 2);
  const bool mine =
      receiver == static_cast<unsigned>(config_.device) || receiver == kAllManipulators || receiver == kEverybody;
  if (field(bytes, 0, 1) != kVersion10 || !mine) return request;
  request.sender = field(bytes, 4, 2);
  request.number = field(bytes, 6, 2);
  request.options = field(bytes, 8, 4);
  request.type = field(bytes, 12, 2);
  for (std::size_t at = 16; at < size;) {
    const unsigned type = field(bytes, at, 2), count = field(bytes, at + 2, 2);
    at += 4;
    auto& block = request.blocks.emplace_back();
    for (unsigned i = 0; i < count; ++i, at += 4) {
      if (type == kInt32 || type == kUint32) block.push_back(static_cast<std::int32_t>(field(bytes, at, 4)));
    }
  }
  return request;
}

void SensapexEmulator::handle(const Request& request, double time) {
  if ((request.options & kOptRequest) == 0) return;
  const bool failed = std::exchange(fails_, false);
  std::vector<std::int32_t> response;
  bool understood = !failed;
  if (failed) {
  } else if (request.type == kCmdStop) {
    stop();
  } else if (request.type == kCmdPositions) {
    response = positions();
  } else if (request.type == kCmdVersion) {
    response = {1, 502, 0};
  } else if (request.type == kCmdParameter) {
    understood = request.blocks.size() == 1 && request.blocks[0] == std::vector<std::int32_t>{kParamAxisCount};
    response = {kParamAxisCount, config_.axes};
  } else if (request.type == kCmdGoto) {
    understood = goTo(request);
  } else if (request.type != kCmdPing) {
    understood = false;
  }
  const unsigned error = understood ? 0 : kOptError;
  if (request.options & kOptReqAck) say(request.sender, request.number, kOptAck | error, request.type, {}, time);
  if (request.options & kOptReqResp) {
    say(request.sender, request.number, error, request.type, understood ? response : std::vector<std::int32_t>{}, time);
  }
}

/// x, y, z [, d [, speed [, 1: all axes at once [, acceleration]]]], and in a second block a speed for
/// each axis.
bool SensapexEmulator::goTo(const Request& request) {
  if (moving_ || request.blocks.empty() || request.blocks[0].size() < 3) return false;
  const std::vector<std::int32_t>& arguments = request.blocks[0];
  const double furthest = config_.travel * 1e9;
  const double speed = arguments.size() > 4 ? speedOf(arguments[4]) : 1e6;
  for (std::size_t i = 0; i < 4; ++i) {
    const bool told = i < std::min<std::size_t>(arguments.size(), 4) && arguments[i] != kArgUndef;
    if (told && static_cast<int>(i) >= config_.axes) return false;
    end_[i] = told ? std::clamp(static_cast<double>(arguments[i]), -furthest, furthest) : at_[i];
    const bool of_its_own = request.blocks.size() > 1 && i < request.blocks[1].size();
    speed_[i] = of_its_own ? speedOf(request.blocks[1][i]) : speed;
    if (told && speed_[i] <= 0) return false;
  }
  together_ = arguments.size() > 5 && arguments[5] == 1;
  driver_ = request.options & kOptReqNotify ? request.sender : 0;
  moving_ = true;
  ++moves_begun_;
  return true;
}

void SensapexEmulator::advance(double time) {
  const double dt = time - time_;
  time_ = std::max(time, time_);
  if (!moving_ || dt <= 0) return;
  for (std::size_t i = 0; i < 4; ++i) {
    const double left = end_[i] - at_[i], step = speed_[i] * dt;
    if (left == 0) continue;
    at_[i] = std::abs(left) <= step ? end_[i] : at_[i] + std::copysign(step, left);
    if (!together_) break;  // the next one when this one is there
  }
  if (at_ != end_) return;
  moving_ = false;
  if (driver_ > 0) say(driver_, ++notifications_, kOptNotify, kNotifyGotoDone, {0}, time);
}

void SensapexEmulator::stop() {
  for (double& each : at_) each = std::round(each);
  moving_ = false;
}

std::vector<std::int32_t> SensapexEmulator::positions() {
  std::vector<std::int32_t> numbers;
  const double aside = moving_ ? 0 : config_.jitter * 1e9 * (++jitters_ % 3 - 1);
  for (int i = 0; i < config_.axes; ++i) {
    numbers.push_back(static_cast<std::int32_t>(std::lround(at_[static_cast<std::size_t>(i)] + aside)));
  }
  return numbers;
}

void SensapexEmulator::say(unsigned receiver, unsigned number, unsigned options, unsigned type,
                           const std::vector<std::int32_t>& numbers, double time) {
  std::string bytes = asBytes(kVersion10, 1) + asBytes(0, 1) + asBytes(receiver, 2) +
                      asBytes(static_cast<unsigned>(config_.device), 2) + asBytes(number & 0xffff, 2) +
                      asBytes(options, 4) + asBytes(type, 2) + asBytes(numbers.empty() ? 0 : 1, 2);
  if (!numbers.empty()) bytes += asBytes(kInt32, 2) + asBytes(static_cast<unsigned>(numbers.size()), 2);
  for (const std::int32_t each : numbers) bytes += asBytes(static_cast<unsigned>(each), 4);
  sendAt(time + config_.answer_time, bytes);
}

void SensapexEmulator::interrupt(double time) {
  advance(time);
  stop();
}

void SensapexEmulator::checkError(const std::string& code) const {
  const auto number = parseNumber<int>(code);
  if (code == kReset || (number && *number >= 0 && *number <= 999)) return;
  throw ConfigError("fault = error:" + code + ": must be a number from 0 to 999, or RESET");
}

void SensapexEmulator::failNextCommand(const std::string& code) {
  if (code != kReset) {
    fails_ = true;
    return;
  }
  received_.clear();
  dropReplies();
  at_.fill(0);
  moving_ = fails_ = false;
  say(0x3ff, ++notifications_, kOptNotify, kNotifyHello, {}, time_);
}

}  // namespace microinjection
