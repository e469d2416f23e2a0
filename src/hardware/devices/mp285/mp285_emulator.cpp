#include "hardware/devices/mp285/mp285_emulator.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/errors.h"

namespace microinjection {
namespace {

constexpr double kMicrostepsPerMicrometre = 25;  // of its speed unit

std::string fourBytes(double value) {
  const auto number = static_cast<std::int32_t>(std::lround(value));
  std::string bytes;
  bytes += static_cast<char>(number & 0xff);
  bytes += static_cast<char>((number >> 8) & 0xff);
  bytes += static_cast<char>((number >> 16) & 0xff);
  bytes += static_cast<char>((number >> 24) & 0xff);
  return bytes;
}

double fromFourBytes(const unsigned char* bytes) {
  const std::uint32_t number = bytes[0] + 256u * bytes[1] + 65536u * bytes[2] + 16777216u * bytes[3];
  return static_cast<std::int32_t>(number);
}

/// Length of a command with its carriage return; 0: unknown command.
std::size_t commandLength(unsigned char letter) {
  switch (letter) {
    case 'c':
    case 's':
    case 'a':
    case 'b':
    case 'o':
    case 'n':
    case 'e':
    case 'r':
      return 2;
    case 'V':
      return 4;
    case 'm':
      return 14;
    default:
      return 0;
  }
}

}  // namespace

void Mp285Emulator::switchOn() {
  position_.setZero();
  speed_ = config_.speed;
  fine_ = config_.fine;
  moving_ = false;
  absolute_ = true;
  fails_at_ = error_ = -1;
  command_.clear();
  dropReplies();
}

void Mp285Emulator::failNextCommand(const std::string& code) {
  code == kReset ? switchOn() : void(error_ = std::stoi(code));
}

void Mp285Emulator::advance(double time) {
  const double dt = time - time_;
  time_ = std::max(time, time_);
  if (!moving_ || dt <= 0) return;
  const Eigen::Vector3d displacement = end_ - position_;
  const double step = speed_ * kMicrostepsPerMicrometre * dt;  // microsteps
  const double left = displacement.norm() - step;
  if (fails_at_ >= 0 && left <= fails_at_) return interrupt(time);
  if (left > 0) {
    position_ += displacement.normalized() * step;
    return;
  }
  position_ = end_;
  moving_ = false;
  reply("\r", time);
}

void Mp285Emulator::interrupt(double time) {
  advance(time);
  fails_at_ = -1;
  if (!moving_) return;
  moving_ = false;
  position_ = position_.array().round();
  replyError(std::exchange(fails_with_, 8), time);
}

void Mp285Emulator::replyError(int code, double time) {
  reply(std::string(1, static_cast<char>(config_.ascii_errors ? '0' + code : code)) + '\r', time);
}

void Mp285Emulator::stop(double time) {
  reply(moving_ ? "=\r" : "\r", time);
  position_ = position_.array().round();
  moving_ = false;
  fails_at_ = -1;
}

void Mp285Emulator::process(const std::string& bytes, double time) {
  advance(time);
  for (const char each : bytes) receiveByte(static_cast<unsigned char>(each), time);
}

void Mp285Emulator::receiveByte(unsigned char byte, double time) {
  if (time - last_byte_ > config_.half_command_time && (!config_.locks_up || byte == 0x03)) command_.clear();
  last_byte_ = time;
  if (moving_ && byte != 0x03) return;
  if (command_.empty() && byte == 0x03) return stop(time);
  if (command_.empty() && time < deaf_until_) return;
  if (command_.empty() && byte == 0x0a) return reply("\r", time);
  if (command_.empty() && commandLength(byte) == 0) {
    if (byte != 0x0d) replyError(4, time);
    return;
  }
  command_.push_back(byte);
  if (command_.size() < commandLength(command_[0])) return;
  if (byte != 0x0d) {
    replyError(4, time);
  } else {
    handleCommand(time);
  }
  command_.clear();
}

void Mp285Emulator::handleCommand(double time) {
  const bool fails_on_path = error_ >= 8 && command_[0] == 'm';
  if (error_ >= 0 && error_ < 8) {
    replyError(error_, time);
    error_ = -1;
    return;
  }
  switch (command_[0]) {
    case 'c':
      return reply(fourBytes(position_.x()) + fourBytes(position_.y()) + fourBytes(position_.z()) + '\r', time);
    case 's':
      return reply(status(), time);
    case 'V': {
      const int setting = command_[1] + 256 * command_[2];
      fine_ = setting >= 0x8000;
      speed_ = std::clamp(setting & 0x7fff, 1, fine_ ? 1310 : 6550);
      return reply("\r", time);
    }
    case 'm':
      beginMove();
      if (!fails_on_path) return;
      fails_at_ = (end_ - position_).norm() / 2;
      fails_with_ = std::exchange(error_, -1);
      return;
    case 'o':
      position_.setZero();
      return reply("\r", time);
    case 'r':
      return;  // a reset has no reply
    default:   // also n and e: it has no display and no programs, thus no pause to end
      absolute_ = command_[0] == 'b' ? false : command_[0] == 'a' ? true : absolute_;
      reply("\r", time);
  }
}

void Mp285Emulator::beginMove() {
  const double grid = fine_ ? 1 : 5;
  for (int i = 0; i < 3; ++i) {
    const double commanded =
        fromFourBytes(&command_[1 + 4 * static_cast<std::size_t>(i)]) + (absolute_ ? 0 : position_[i]);
    const double furthest = config_.travel / config_.microsteps[i];
    end_[i] = std::clamp(std::round(commanded / grid) * grid, -furthest, furthest);
  }
  moving_ = true;
  ++moves_begun_;
}

/// 32 bytes as a client printed them from a real device, and a carriage return. Its variable values
/// are STEP_DIV at 24, STEP_MUL at 26 and speed at 28. FLAGS stays 64, since clients disagree on
/// the bit for the mode of moves.
std::string Mp285Emulator::status() const {
  constexpr unsigned char kReal[] = {64,  0,  2,  4,  7,  0, 99, 0, 99, 0, 20, 0, 136, 19, 1,  120,
                                     112, 23, 16, 39, 80, 0, 0,  0, 25, 0, 4,  0, 200, 0,  84, 1};
  std::string bytes(reinterpret_cast<const char*>(kReal), sizeof(kReal));
  const auto put = [&](std::size_t at, int number) {
    bytes[at] = static_cast<char>(number % 256);
    bytes[at + 1] = static_cast<char>(number / 256);
  };
  put(24, config_.step_div);
  put(26, config_.step_mul);
  put(28, speed_ + (fine_ ? 0x8000 : 0));
  return bytes + '\r';
}

std::string Mp285Emulator::produce(double time) {
  const std::string output = ManipulatorEmulator::produce(time);
  if (!output.empty()) {
    deaf_until_ = time + static_cast<double>(output.size()) * 10 / config_.baud + config_.command_pause;
  }
  return output;
}

void Mp285Emulator::checkError(const std::string& code) const {
  const bool digits = !code.empty() && code.size() <= 2 && code.find_first_not_of("0123456789") == std::string::npos;
  if (code == kReset || (digits && std::stoi(code) <= 15)) return;
  throw ConfigError("fault = error:" + code + ": must be 0, the sum of 1, 2, 4 and 8, or RESET");
}

}  // namespace microinjection
