#include "hardware/devices/zaber/zaber_emulator.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <utility>

#include "base/errors.h"
#include "base/parse_number.h"

namespace microinjection {
namespace {

constexpr double kRestCheckPeriod = 0.5e-3;  // s, between two checks whether an axis came to rest
constexpr std::size_t kLongestRequest = 80;  // characters
constexpr char kNoReply[] = "--";            // in the place of a message ID

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
  return code.size() == 2 && (code[0] == 'F' || code[0] == 'W' || code[0] == 'N') &&
         std::isalnum(static_cast<unsigned char>(code[1]));
}

/// MAJOR.MINOR, whole numbers.
bool parseVersion(const std::string& text, int& major, int& minor) {
  int used = 0;
  const int numbers = std::sscanf(text.c_str(), "%3d.%3d%n", &major, &minor, &used);
  return numbers == 2 && used == static_cast<int>(text.size()) && text[0] != '-' && minor >= 0;
}

std::string digits(const char* format, int number) {
  char text[16];
  std::snprintf(text, sizeof(text), format, number);
  return text;
}

/// Removes a whole number from the front; empty: there is none.
std::optional<int> popNumber(std::vector<std::string>& words) {
  const auto number = words.empty() || !std::isdigit(static_cast<unsigned char>(words[0][0]))
                          ? std::nullopt
                          : parseNumber<int>(words[0]);
  if (number) words.erase(words.begin());
  return number;
}

/// Removes the checksum. Returns whether the line is valid.
bool checkSum(std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return true;
  const int received = static_cast<int>(std::strtol(text.c_str() + colon + 1, nullptr, 16));
  text.erase(colon);
  return (sumOf(text) + received) % 256 == 0;
}

}  // namespace

ZaberEmulator::ZaberEmulator(const ZaberEmulatorConfig& config) : config_(config) { build(); }

void ZaberEmulator::build() {
  ZaberEmulatedAxis::Config axis;
  axis.travel = config_.travel / config_.microstep;
  axis.start = config_.start / config_.microstep;
  axis.acceleration = config_.acceleration / config_.microstep;
  axis.speed = config_.speed / config_.microstep;
  axis.referenced = config_.referenced;
  axes_.assign(3, ZaberEmulatedAxis(axis));
  devices_.clear();
  for (int i = 0; i < 3; ++i) {
    Device& device = devices_[config_.devices[i]];
    device.axes[config_.axes[i]] = &axes_[i];
    device.alerts = config_.alerts;
    device.checksum = config_.checksum;
  }
  setFirmware(config_.firmware);
}

void ZaberEmulator::configure(ConfigReader& reader) {
  bool chained = false;
  reader.boolean("chained", chained);
  reader.boolean("alerts", config_.alerts);
  reader.integer("info_every", config_.info_every, Range::nonNegative());
  reader.number("acceleration", config_.acceleration, Range::positive());
  if (chained) {
    config_.devices = {1, 2, 3};
    config_.axes = {1, 1, 1};
  }
  build();
}

void ZaberEmulator::setFirmware(const std::string& version) {
  int major = 0, minor = 0;
  if (!parseVersion(version, major, minor) || (major != 6 && major != 7)) {
    throw ConfigError("firmware = " + version + ": must be a version of the ASCII protocol, 6.MINOR or 7.MINOR");
  }
  config_.firmware = version;
  for (ZaberEmulatedAxis& axis : axes_) axis.setMoveSpeeds(major == 7 && minor >= 25);
}

Eigen::Vector3d ZaberEmulator::position() const {
  return config_.microstep * Eigen::Vector3d(axes_[0].position(), axes_[1].position(), axes_[2].position());
}

int ZaberEmulator::movesBegun() const { return axes_[0].movesBegun() + axes_[1].movesBegun() + axes_[2].movesBegun(); }

bool ZaberEmulator::moves() const {
  return std::any_of(axes_.begin(), axes_.end(), [](const ZaberEmulatedAxis& axis) { return axis.busy(); });
}

void ZaberEmulator::shiftByHand(const Eigen::Vector3d& displacement) {
  for (int i = 0; i < 3; ++i) axes_[i].shift(displacement[i] / config_.microstep);
}

void ZaberEmulator::advance(double time) {
  while (time_ < time) {
    const double dt = std::min(kRestCheckPeriod, time - time_);
    time_ += dt;
    for (auto& [number, device] : devices_) {
      for (auto& [axis_number, axis] : device.axes) {
        const bool moved = axis->busy();
        axis->advance(dt);
        if (!moved || axis->busy() || !device.alerts) continue;
        queueLine('!', device,
                  digits("%02d ", number) + digits("%d IDLE ", axis_number) + zaberFlagShown(axis->flags()), 0);
      }
    }
  }
}

void ZaberEmulator::process(const std::string& bytes, double time) {
  advance(time);
  for (const char each : bytes) {
    if (each == '/') {
      line_ = "/";
    } else if (each == '\n' || each == '\r') {
      if (!line_.empty()) handleCommand(line_.substr(1));
      line_.clear();
    } else if (!line_.empty() && line_.size() < kLongestRequest) {
      line_ += each;
    }
  }
}

void ZaberEmulator::handleCommand(const std::string& line) {
  std::string text = line;
  if (!checkSum(text)) return;  // ignored
  std::istringstream stream(text);
  Command command;
  for (std::string word; stream >> word;) command.words.push_back(word);
  // Device, axis and message ID precede the command; each may be left out, with those after it.
  command.device = popNumber(command.words).value_or(0);
  command.axis = popNumber(command.words).value_or(0);
  if (const auto id = popNumber(command.words)) command.id = digits("%02d ", *id % 100);
  if (!command.words.empty() && command.words[0] == kNoReply) {
    command.answers = false;
    command.words.erase(command.words.begin());
  }
  for (auto& [number, device] : devices_) {
    if (command.device == 0 || command.device == number) handleCommand(number, device, command);
  }
}

/// Sends the reply of one device.
void ZaberEmulator::handleCommand(int number, Device& device, const Command& command) {
  const bool there = command.axis == 0 || device.axes.count(command.axis) > 0;
  std::string output = !there ? "RJ BADAXIS" : "RJ " + std::exchange(rejection_, "");
  if (output == "RJ ") output = perform(number, device, command);
  if (!command.answers) return;
  const int axis = there ? command.axis : 0;
  bool busy = false;
  for (const auto& [axis_number, each] : device.axes) {
    busy = busy || ((axis == 0 || axis == axis_number) && each->busy());
  }
  const std::string address = digits("%02d ", number) + digits("%d ", axis) + command.id;
  queueLine('@', device,
            address + output.substr(0, 3) + (busy ? "BUSY " : "IDLE ") + zaberFlagShown(flags(device, axis)) +
                output.substr(2),
            config_.answer_time);
  const bool help = !command.words.empty() && command.words[0] == "help";
  const bool in_turn = config_.info_every > 0 && ++replies_ % config_.info_every == 0;
  if (help || in_turn) queueLine('#', device, address + "see the ASCII protocol manual", config_.answer_time);
}

/// Executes a command for a device or its axes. Returns "OK <data>" or "RJ <reason>".
std::string ZaberEmulator::perform(int number, Device& device, const Command& command) {
  const std::vector<std::string>& words = command.words;
  if (words.empty()) return "OK 0";
  if (words[0] == "help") return "OK 0";
  const auto& without = config_.without;
  if (words.size() > 1 && std::count(without.begin(), without.end(), words[1]) > 0) return "RJ BADCOMMAND";
  if (words == std::vector<std::string>{"system", "reset"}) {
    if (command.axis != 0) return "RJ DEVICEONLY";
    for (auto& [axis_number, axis] : device.axes) axis->restart();
    return "OK 0";
  }
  std::string output;
  if (words[0] == "get" && words.size() == 2) output = get(number, device, words[1]);
  if (words[0] == "set" && words.size() == 3 && output.empty()) output = set(device, words[1], words[2]);
  if (output.empty()) return performOnAxes(device, command);
  return command.axis == 0 ? output : "RJ DEVICEONLY";
}

/// Joins the replies of the axes; `warnings` lists each flag once.
std::string ZaberEmulator::performOnAxes(Device& device, const Command& command) {
  const std::vector<std::string> before = flags(device, command.axis);
  std::string data;
  bool none = true;
  for (auto& [number, axis] : device.axes) {
    if (command.axis != 0 && command.axis != number) continue;
    const std::string output = axis->perform(command.words);
    if (output.substr(0, 2) == "RJ") return output;
    none = none && output == "OK 0";
    data += output.substr(2);
  }
  if (command.words[0] == "warnings") return "OK " + listOfZaberFlags(before);
  return none && command.words[0] != "get" ? "OK 0" : "OK" + data;
}

std::vector<std::string> ZaberEmulator::flags(const Device& device, int axis) {
  std::vector<std::string> all;
  for (const auto& [number, each] : device.axes) {
    if (axis != 0 && axis != number) continue;
    for (const std::string& flag : each->flags()) all.push_back(flag);
  }
  return sortedZaberFlags(all);
}

/// Empty: no setting of a device.
std::string ZaberEmulator::get(int number, const Device& device, const std::string& name) const {
  if (name == "version") return "OK " + config_.firmware;
  if (name == "deviceid" || name == "device.id") return "OK 50000";
  if (name == "system.serial") return "OK " + std::to_string(config_.serial + number);
  if (name == "system.access") return "OK " + std::to_string(device.access);
  if (name == "system.axiscount") return "OK " + std::to_string(device.axes.size());
  if (name == "comm.address") return "OK " + std::to_string(number);
  if (name == "comm.alert") return device.alerts ? "OK 1" : "OK 0";
  if (name == "comm.checksum") return device.checksum ? "OK 1" : "OK 0";
  if (name == "comm.protocol") return "OK 2";
  if (name == "comm.rs232.baud") return "OK 115200";
  return "";
}

/// Empty: no writable setting of a device.
std::string ZaberEmulator::set(Device& device, const std::string& name, const std::string& data) {
  if (name == "comm.alert" || name == "comm.checksum") {
    if (data != "0" && data != "1") return "RJ BADDATA";
    (name == "comm.alert" ? device.alerts : device.checksum) = data == "1";
    return "OK 0";
  }
  if (name == "system.access") {
    if (data != "1" && data != "2") return "RJ BADDATA";
    device.access = data[0] - '0';
    return "OK 0";
  }
  return "";
}

void ZaberEmulator::queueLine(char kind, const Device& device, const std::string& text, double delay) {
  const std::string sum = device.checksum ? digits(":%02X", (256 - sumOf(text)) % 256) : "";
  sendAt(time_ + delay, kind + text + sum + "\r\n");
}

void ZaberEmulator::checkError(const std::string& code) const {
  const auto& names = rejections();
  if (isFlagName(code) || code == kReset || std::find(names.begin(), names.end(), code) != names.end()) return;
  std::string all;
  for (const std::string& name : names) all += name + ", ";
  throw ConfigError("fault = error:" + code + ": must be one of " + all +
                    "RESET or a flag: F, W or N and a letter, e.g. FS");
}

void ZaberEmulator::failNextCommand(const std::string& code) {
  if (code != kReset && !isFlagName(code)) {
    rejection_ = code;
    return;
  }
  for (ZaberEmulatedAxis& axis : axes_) code == kReset ? axis.restart() : axis.raise(code);
}

void ZaberEmulator::interrupt(double time) {
  advance(time);
  for (ZaberEmulatedAxis& axis : axes_) axis.interrupt();
}

}  // namespace microinjection
