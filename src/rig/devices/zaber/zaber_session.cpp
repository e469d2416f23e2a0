// The begin of ZaberDriver's sessions: what must be known before anything may move.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "rig/devices/zaber/zaber_driver.h"

namespace microinjection {
namespace {

constexpr double kLongestBraking = 1.5;                // s, after a stop
constexpr double kLongestHoming = 120;                 // s
constexpr int kSettingTries = 120;                     // of 18 settings that are told twice each
constexpr double kAgreement = 0.1;                     // share by which an acceleration may differ from the file's
constexpr double kAccelUnit = kZaberSpeedUnit * 1e-4;  // data of the device's accelerations for 1 microstep/s^2

std::string text(double value) {
  char digits[32];
  std::snprintf(digits, sizeof(digits), "%.3g", value);
  return digits;
}

}  // namespace

void ZaberDriver::connected() {
  for (Axis& axis : axes_) axis.settings.clear();
  answer_time_ = config_.answer_time;
  acceleration_ = config_.acceleration;
}

void ZaberDriver::begin(bool lost) {
  exchange_.reset();
  parser_.clear();
  answers_.clear();
  begun_ = listened();
  lost_ = lost;
  settled_ = false;
  turn_ = move_stage_ = setting_tries_ = 0;
  for (int i = 0; i < 3; ++i) {
    Axis& axis = axes_[i];
    axis.filter.clear();
    axis.told.reset();
    axis.coasting = lost || axis.velocity == 0 ? 0 : config_.reading_margin;
    if (axis.position) axis.position = expected(i, time());
    axis.position_time = time();
    axis.velocity = 0;
    axis.end = std::nan("");
    axis.read_since_begin = axis.homed = axis.still_moves = false;
    axis.busy = true;
    axis.cleared = !clearing();
    axis.stalls = axis.lists = 0;
    axis.listed.clear();
    if (lost) axis.lists_due = 2;
    if (clearing()) axis.settings.clear();  // they may have been what was wrong
  }
}

/// Faults are cleared, every axis must have told its warnings and been read, and be at rest; its settings are known.
bool ZaberDriver::nextOfSession() {
  if (settled_) return false;
  for (int i = 0; i < 3; ++i) {
    if (nextOfAxis(i)) return true;
  }
  if (nextOfHoming()) return true;
  if (nextOfSettings()) return true;
  if (const std::string wrong = checkSettings(); !wrong.empty()) return raiseFault(wrong), true;
  adaptToAnswers();
  // Another axis' homing takes long.
  for (int i = 0; i < 3; ++i) {
    if (listened() - axes_[i].heard > turnTime()) return ask(Kind::kPosition, i, "get pos"), true;
  }
  settled_ = true;
  may_home_ = false;
  known();
  return false;
}

bool ZaberDriver::nextOfAxis(int i) {
  Axis& axis = axes_[i];
  if (!axis.cleared) return ask(Kind::kClear, i, "warnings clear"), true;
  // While it homes it still has none; that must not be the last that is heard of it.
  if (axis.lists_due > 0 && !(axis.homed && axis.busy)) return ask(Kind::kWarnings, i, "warnings"), true;
  // Braking, or the session's stop did not reach it.
  if (axis.still_moves && !axis.homed) return ask(Kind::kStop, i, "stop"), true;
  if (!axis.busy && !axis.has_reference) return false;  // its position means nothing; see nextOfHoming
  if (axis.read_since_begin && !axis.busy && !axis.filter.isImplausible()) return false;
  if (listened() - begun_ > (axis.homed ? kLongestHoming : kLongestBraking)) {
    lostStep(axisName(i) + (axis.busy ? " does not come to rest" : " has no steady position"));
  } else {
    ask(Kind::kPosition, i, "get pos");
  }
  return true;
}

/// What the devices are, asked once for a connection and when a fault is cleared.
bool ZaberDriver::nextOfSettings() {
  for (int i = 0; i < 3; ++i) {
    const auto missing = axes_[i].settings.missing();
    if (!missing) continue;
    const std::string command = ZaberSettings::command(*missing);
    if (++setting_tries_ > kSettingTries) {
      lostStep(axisName(i) + " gives no answer to \"" + command + "\" that is one");
    } else {
      ask(Kind::kSetting, i, command, *missing);
    }
    return true;
  }
  return false;
}

void ZaberDriver::takeSetting(const Exchange& asked, const std::string& data) {
  const auto name = static_cast<ZaberSettings::Name>(asked.value);
  if (!ZaberSettings::ofDevice(name)) return axes_[asked.axis].settings.take(name, data);
  for (int i = 0; i < 3; ++i) {
    if (config_.addresses[i].device == asked.to.device) axes_[i].settings.take(name, data);
  }
}

/// Why the device is not the one that the file describes; else empty.
std::string ZaberDriver::contradiction(int i) const {
  const ZaberSettings& settings = axes_[i].settings;
  const double unit = config_.microsteps_per_metre[i] * kAccelUnit;  // for 1 m/s^2
  for (const auto name : {ZaberSettings::kAcceleration, ZaberSettings::kDeceleration}) {
    const auto data = settings.number(name);
    if (!data) continue;
    const double told = static_cast<double>(*data) / unit;
    if (std::abs(told - config_.acceleration) <= kAgreement * config_.acceleration) continue;
    return axisName(i) + ": acceleration = " + text(config_.acceleration) +
           " m/s^2 in the file: must be within a tenth of the device's, which is " + text(told) + " m/s^2 (\"" +
           ZaberSettings::command(name) + "\" says " + std::to_string(*data) + "); change either";
  }
  const auto resolution = settings.number(ZaberSettings::kResolution);
  if (config_.resolution == 0 || !resolution || *resolution == config_.resolution) return "";
  return axisName(i) + ": resolution = " + std::to_string(config_.resolution) +
         " in the file: must be the device's, which is " + std::to_string(*resolution) +
         " microsteps a full step; microsteps_per_metre changes with it";
}

/// Takes over the acceleration that the devices tell. Returns what is wrong with their settings; else empty.
std::string ZaberDriver::checkSettings() {
  double slowest = config_.acceleration * (1 + kAgreement);  // m/s^2
  for (int i = 0; i < 3; ++i) {
    const std::string wrong = contradiction(i);
    if (!wrong.empty()) return wrong;
    for (const auto name : {ZaberSettings::kAcceleration, ZaberSettings::kDeceleration}) {
      const auto data = axes_[i].settings.number(name);
      if (data)
        slowest = std::min(slowest, static_cast<double>(*data) / (config_.microsteps_per_metre[i] * kAccelUnit));
    }
  }
  acceleration_ = slowest;
  return "";
}

/// The turn, the gain and how long is waited follow the time that answers take. After a mere stop that is known.
void ZaberDriver::adaptToAnswers() {
  const auto measured = answers_.measured();
  if (!lost_ || !measured) return;
  answer_time_ = std::max(config_.answer_time, *measured);
  const double wire = (kZaberCommandBytes + kZaberReplyBytes) * config_.byteTime();
  waitForSilence(answer_time_ + 60 * config_.byteTime() + 5e-3,
                 std::max(config_.reply_timeout, 3 * answer_time_) + wire);
}

/// What looking for the reference positions needs next; false: nothing.
bool ZaberDriver::nextOfHoming() {
  const auto lacks = [](const Axis& axis) { return !axis.has_reference; };
  const auto lacking = std::find_if(axes_.begin(), axes_.end(), lacks);
  const bool begun = std::any_of(axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.homed; });
  if (lacking == axes_.end() && !begun) return false;
  const int first = static_cast<int>(lacking - axes_.begin());
  if (state() == State::kFault && !clearing()) {  // no position is told
    ask(Kind::kWarnings, lacking == axes_.end() ? 0 : first, "warnings");
    return true;
  }
  // Neither a cleared fault nor a device that was switched off and on is leave to move.
  const bool may = may_home_ && !clearing() && homing_.refusal.empty();
  if (lacking != axes_.end() && (!may || lacking->homed)) {
    raiseFault(axisName(first) + " has no reference position: " +
               (homing_.refusal.empty() ? "home it, by its maker's tool or by home: true at the start"
                                        : "home: true is refused, " + homing_.refusal));
    return true;
  }
  for (const int i : homing_.order) {
    if (axes_[i].homed) continue;
    if (!may) return false;
    home(i);
    return true;
  }
  return false;
}

/// Who stops a homing does not want it to begin again.
void ZaberDriver::stopAsked() {
  if (std::any_of(axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.homed; })) may_home_ = false;
}

void ZaberDriver::home(int i) {
  Axis& axis = axes_[i];
  movesByItself();
  axis.position.reset();  // its numbers begin anew
  axis.read_since_begin = false;
  axis.lists_due = 1;
  begun_ = listened();
  ask(Kind::kHome, i, "home");
}

}  // namespace microinjection
