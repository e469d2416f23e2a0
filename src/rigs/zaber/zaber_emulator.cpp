#include "rigs/zaber/zaber_emulator.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <sstream>

#include "base/errors.h"

namespace microinjection {
namespace {

constexpr double kLongestStep = 0.5e-3;   // s, of the motion's integration
constexpr std::size_t kLongestLine = 80;  // characters
constexpr double kSpeedData = 1.6384;     // for 1 microstep/s
constexpr double kAccelData = 1.6384e-4;  // for 1 microstep/s^2

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

/// MAJOR.MINOR, whole numbers.
bool parseVersion(const std::string& text, int& major, int& minor) {
  int used = 0;
  const int numbers = std::sscanf(text.c_str(), "%3d.%3d%n", &major, &minor, &used);
  return numbers == 2 && used == static_cast<int>(text.size()) && text[0] != '-' && minor >= 0;
}

}  // namespace

ZaberEmulator::ZaberEmulator(const ZaberEmulatorConfig& config) : config_(config) {
  for (int i = 0; i < 3; ++i) {
    axes_[i] = {};
    axes_[i].device = config.devices[i];
    axes_[i].number = config.axes[i];
    axes_[i].place = std::round(config.start / config.microstep);
    axes_[i].max_speed = axes_[i].move_speed = config.speed / config.microstep;
    axes_[i].acceleration = config.acceleration / config.microstep;
    axes_[i].referenced = config.referenced;
  }
  setFirmware(config.firmware);
}

void ZaberEmulator::setFirmware(const std::string& version) {
  int major = 0, minor = 0;
  if (!parseVersion(version, major, minor) || (major != 6 && major != 7)) {
    throw ConfigError("firmware = " + version + ": must be a version of the ASCII protocol, 6.MINOR or 7.MINOR");
  }
  config_.firmware = version;
  moves_have_speeds_ = major == 7 && minor >= 25;
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
  const double change = axis.acceleration * dt;  // microsteps/s
  double wanted = axis.target_velocity;
  if (axis.to_place) {
    const double left = axis.target - axis.place;
    // The speed from which it can still brake in time, with the steps of the integration allowed for.
    const double braking = std::sqrt(2 * change / dt * std::abs(left) + change * change / 4) - change / 2;
    wanted = std::copysign(std::min(axis.move_speed, braking), left);
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
  if (command == "get version" && number == 0) return tellVersion(device, id, checksum);
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

/// It belongs to a device and not to an axis: each device answers once, for all its axes.
void ZaberEmulator::tellVersion(int device, const std::string& id, bool checksum) {
  std::vector<int> told;
  for (const Axis& axis : axes_) {
    if ((device != 0 && device != axis.device) || std::count(told.begin(), told.end(), axis.device) != 0) continue;
    told.push_back(axis.device);
    Axis all = axis;
    all.number = 0;
    answer(all, id, "OK " + config_.firmware, checksum);
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
    axis.acceleration = config_.acceleration / config_.microstep;
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
    axis.max_speed = value / kSpeedData;
    return "OK 0";
  }
  if (verb == "home") {
    axis.homing = axis.to_place = true;
    axis.target = 0;
    axis.move_speed = axis.max_speed;
    return "OK 0";
  }
  if (verb == "get" && what == "version") return "RJ BADAXIS";
  if (verb == "move") return beginMove(axis, what, argument + std::string(std::istreambuf_iterator<char>(words), {}));
  return "RJ BADCOMMAND";
}

/// `data`: place or velocity, and from firmware 7.25 on speed (not of a velocity) and acceleration, where they are
/// given.
std::string ZaberEmulator::beginMove(Axis& axis, const std::string& how, const std::string& data) {
  if (!axis.flag.empty() && axis.flag[0] == 'F') return "RJ STATUSBUSY";
  if (how != "abs" && how != "rel" && how != "vel" && how != "min" && how != "max") return "RJ BADCOMMAND";
  const bool to_end = how == "min" || how == "max", at_velocity = how == "vel";
  std::vector<double> values;
  std::istringstream words(data);
  for (std::string word; words >> word;) {
    char* rest = nullptr;
    values.push_back(static_cast<double>(std::strtoll(word.c_str(), &rest, 10)));
    if (*rest != '\0') return "RJ BADDATA";
  }
  const std::size_t needed = to_end ? 0 : 1, allowed = needed + (!moves_have_speeds_ ? 0 : at_velocity ? 1 : 2);
  if (values.size() < needed || values.size() > allowed) return "RJ BADDATA";
  const std::vector<double> options(values.begin() + static_cast<std::ptrdiff_t>(needed), values.end());
  if (std::any_of(options.begin(), options.end(), [](double value) { return value < 1; })) return "RJ BADDATA";
  const std::size_t acceleration_at = at_velocity ? 0 : 1;
  const double end = config_.travel / config_.microstep;
  if (!to_end && !at_velocity) {
    const double target = how == "abs" ? values[0] : std::round(axis.place) + values[0];
    if (target < 0 || target > end || (!axis.referenced && how == "abs")) return "RJ BADDATA";
    axis.target = target;
  } else {
    axis.target = how == "min" ? 0 : std::floor(end);
  }
  axis.acceleration = options.size() > acceleration_at ? options[acceleration_at] / kAccelData
                                                       : config_.acceleration / config_.microstep;
  axis.move_speed = !at_velocity && !options.empty() ? options[0] / kSpeedData : axis.max_speed;
  axis.to_place = !at_velocity;
  axis.target_velocity = at_velocity ? values[0] / kSpeedData : 0;
  if (axis.to_place) ++moves_begun_;
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
