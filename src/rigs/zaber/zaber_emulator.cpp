#include "rigs/zaber/zaber_emulator.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "base/errors.h"

namespace microinjection {
namespace {

constexpr double kLongestStep = 0.5e-3;   // s, of the motion's integration
constexpr std::size_t kLongestLine = 80;  // characters

const std::vector<std::string>& rejections() {
  static const std::vector<std::string> names{"AGAIN",          "BADAXIS", "BADCOMMAND", "BADDATA",
                                              "DRIVERDISABLED", "FULL",    "PARKED",     "STATUSBUSY"};
  return names;
}

/// The sum of all characters and the checksum is 0 modulo 256.
int sumOf(const std::string& text) {
  int sum = 0;
  for (const char each : text) sum += static_cast<unsigned char>(each);
  return sum % 256;
}

bool isFlagName(const std::string& code) {
  return code.size() == 2 && (code[0] == 'F' || code[0] == 'W') && std::isalnum(static_cast<unsigned char>(code[1]));
}

}  // namespace

ZaberEmulator::ZaberEmulator(const ZaberEmulatorConfig& config) : config_(config) {
  for (int i = 0; i < 3; ++i) {
    axes_[i] = {};
    axes_[i].device = config.devices[i];
    axes_[i].number = config.axes[i];
    axes_[i].place = std::round(config.start / config.microstep);
    axes_[i].max_speed = config.speed / config.microstep;
    axes_[i].referenced = config.referenced;
  }
}

Eigen::Vector3d ZaberEmulator::position() const {
  return config_.microstep * Eigen::Vector3d(axes_[0].place, axes_[1].place, axes_[2].place);
}

bool ZaberEmulator::moves() const {
  return std::any_of(axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.busy(); });
}

void ZaberEmulator::shiftByHand(const Eigen::Vector3d& way) {
  for (int i = 0; i < 3; ++i) axes_[i].place = std::round(axes_[i].place + way[i] / config_.microstep);
}

void ZaberEmulator::advanceAxis(Axis& axis, double dt) const {
  const double change = config_.acceleration / config_.microstep * dt;  // microsteps/s
  double wanted = axis.target_velocity;
  if (axis.to_place) {
    const double left = axis.target - axis.place;
    // The speed from which it can still brake in time, with the steps of the integration allowed for.
    const double braking = std::sqrt(2 * change / dt * std::abs(left) + change * change / 4) - change / 2;
    wanted = std::copysign(std::min(axis.max_speed, braking), left);
    if (std::abs(left) < 0.5 && std::abs(axis.velocity) <= 2 * change) {
      axis.place = axis.target;
      axis.velocity = 0;
      axis.to_place = false;
      return;
    }
  }
  axis.velocity += std::clamp(wanted - axis.velocity, -change, change);
  axis.place += axis.velocity * dt;
  const double end = config_.travel / config_.microstep;
  if (!axis.homing && (axis.place < 0 || axis.place > end)) {
    axis.place = std::clamp(axis.place, 0.0, end);
    axis.velocity = axis.target_velocity = 0;
    axis.to_place = false;
  }
  if (!axis.busy()) axis.place = std::round(axis.place);
}

void ZaberEmulator::advance(double time) {
  while (time_ < time) {
    const double dt = std::min(kLongestStep, time - time_);
    for (Axis& axis : axes_) {
      if (axis.busy()) advanceAxis(axis, dt);
      if (axis.homing && !axis.busy()) {
        axis.homing = false;
        axis.referenced = true;
      }
    }
    time_ += dt;
  }
}

void ZaberEmulator::hear(const std::string& bytes, double time) {
  advance(time);
  for (const char each : bytes) {
    if (each == '/') {
      line_ = "/";
    } else if (each == '\n' || each == '\r') {
      if (!line_.empty()) obey(line_);
      line_.clear();
    } else if (!line_.empty() && line_.size() < kLongestLine) {
      line_ += each;
    }
  }
}

void ZaberEmulator::obey(const std::string& line) {
  std::string text = line.substr(1);
  const std::size_t colon = text.find(':');
  const bool checksum = colon != std::string::npos;
  if (checksum) {
    const int said = static_cast<int>(std::strtol(text.c_str() + colon + 1, nullptr, 16));
    text.erase(colon);
    if ((sumOf(text) + said) % 256 != 0) return;  // not heard
  }
  std::istringstream words(text);
  int device = 0, number = 0;
  words >> device >> number;
  if (!words && !text.empty()) return;
  std::string command, id;
  std::getline(words >> std::ws, command);
  if (!command.empty() && std::isdigit(static_cast<unsigned char>(command[0]))) {  // a number of its own
    char digits[16];
    std::snprintf(digits, sizeof(digits), "%02d ", static_cast<int>(std::strtol(command.c_str(), nullptr, 10) % 100));
    id = digits;
    command.erase(0, std::min(command.find(' '), command.size() - 1) + 1);
  }
  for (Axis& axis : axes_) {
    if ((device != 0 && device != axis.device) || (number != 0 && number != axis.number)) continue;
    std::string said;
    if (rejection_.empty()) {
      said = perform(axis, command);
    } else {
      said = "RJ " + rejection_;
      rejection_.clear();
    }
    answer(axis, id, said, checksum);
  }
}

/// Returns "OK <data>" or "RJ <reason>".
std::string ZaberEmulator::perform(Axis& axis, const std::string& command) {
  std::istringstream words(command);
  std::string verb, what, argument;
  words >> verb >> what >> argument;
  if (verb.empty()) return "OK 0";
  if (verb == "stop" || verb == "estop") {
    axis.to_place = axis.homing = false;
    axis.target_velocity = 0;
    if (verb == "estop") axis.velocity = 0;
    return "OK 0";
  }
  if (verb == "warnings") {
    const std::string flag = axis.flag.empty() ? "00" : "01 " + axis.flag;
    if (what == "clear") axis.flag.clear();
    return "OK " + flag;
  }
  if (verb == "get" && what == "pos") return "OK " + std::to_string(std::lround(axis.place));
  if (verb == "get" && what == "limit.min") return "OK 0";
  if (verb == "get" && what == "limit.max")
    return "OK " + std::to_string(std::lround(config_.travel / config_.microstep));
  if (verb == "set" && what == "maxspeed") {
    const long value = std::strtol(argument.c_str(), nullptr, 10);
    if (value < 1) return "RJ BADDATA";
    axis.max_speed = value / 1.6384;
    return "OK 0";
  }
  if (verb == "home") {
    axis.homing = axis.to_place = true;
    axis.target = 0;
    return "OK 0";
  }
  if (verb == "move") return beginMove(axis, what, argument);
  return "RJ BADCOMMAND";
}

std::string ZaberEmulator::beginMove(Axis& axis, const std::string& how, const std::string& argument) {
  if (!axis.flag.empty() && axis.flag[0] == 'F') return "RJ STATUSBUSY";
  const double end = config_.travel / config_.microstep;
  if (how == "min" || how == "max") {
    axis.target = how == "min" ? 0 : std::floor(end);
  } else {
    char* rest = nullptr;
    const double value = static_cast<double>(std::strtoll(argument.c_str(), &rest, 10));
    if (argument.empty() || *rest != '\0') return "RJ BADDATA";
    if (how == "vel") {
      axis.to_place = false;
      axis.target_velocity = value / 1.6384;
      return "OK 0";
    }
    if (how != "abs" && how != "rel") return "RJ BADCOMMAND";
    const double target = how == "abs" ? value : std::round(axis.place) + value;
    if (target < 0 || target > end || (!axis.referenced && how == "abs")) return "RJ BADDATA";
    axis.target = target;
  }
  axis.to_place = true;
  axis.target_velocity = 0;
  ++moves_begun_;
  return "OK 0";
}

void ZaberEmulator::answer(const Axis& axis, const std::string& id, const std::string& said, bool checksum) {
  const std::string flag = !axis.flag.empty() ? axis.flag : axis.referenced ? "--" : "WR";
  char head[32];
  std::snprintf(head, sizeof(head), "%02d %d ", axis.device, axis.number);
  std::string text = head + id + said.substr(0, 3) + (axis.busy() ? "BUSY " : "IDLE ") + flag + said.substr(2);
  if (checksum) {
    char digits[8];
    std::snprintf(digits, sizeof(digits), ":%02X", (256 - sumOf(text)) % 256);
    text += digits;
  }
  answers_.push_back({time_ + config_.answer_time, "@" + text + "\r\n"});
}

std::string ZaberEmulator::say(double time) {
  advance(time);
  std::string said;
  while (!answers_.empty() && answers_.front().due <= time) {
    said += answers_.front().text;
    answers_.erase(answers_.begin());
  }
  return said;
}

void ZaberEmulator::checkError(const std::string& code) const {
  const auto& names = rejections();
  if (isFlagName(code) || std::find(names.begin(), names.end(), code) != names.end()) return;
  std::string all;
  for (const std::string& name : names) all += name + ", ";
  throw ConfigError("fault = error:" + code + ": must be one of " + all + "or a flag: F or W and a letter, e.g. FS");
}

void ZaberEmulator::failNextCommand(const std::string& code) {
  if (!isFlagName(code)) {
    rejection_ = code;
    return;
  }
  for (Axis& axis : axes_) {
    axis.flag = code;
    if (code[0] != 'F') continue;
    axis.to_place = axis.homing = false;
    axis.velocity = axis.target_velocity = 0;
  }
}

void ZaberEmulator::interrupt(double time) {
  advance(time);
  for (Axis& axis : axes_) {
    axis.to_place = axis.homing = false;
    axis.target_velocity = 0;
  }
}

}  // namespace microinjection
