// ZaberDriver: start of a session, with all checks before anything may move.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "rig/devices/zaber/zaber_driver.h"

namespace microinjection {
namespace {

constexpr double kLongestBraking = 1.5;  // s, after a stop
constexpr double kLongestHoming = 120;   // s
constexpr int kSettingTries = 120;       // for 21 settings with two replies each
constexpr double kAgreement = 0.1;       // relative difference allowed between an acceleration and the file's
constexpr double kAccelUnit = kZaberSpeedUnit * 1e-4;  // device data of an acceleration of 1 microstep/s^2

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
  answer_.reset();
  parser_.clear();
  reply_times_.clear();
  begun_ = activeTime();
  lost_ = lost;
  settled_ = false;
  turn_ = move_stage_ = setting_tries_ = 0;
  for (int i = 0; i < 3; ++i) {
    Axis& axis = axes_[i];
    axis.filter.clear();
    axis.sent_velocity.reset();
    axis.coasting = lost || axis.velocity == 0 ? 0 : config_.reading_margin;
    if (axis.position) axis.position = expected(i, time());
    axis.position_time = time();
    axis.velocity = 0;
    axis.end = std::nan("");
    axis.read_since_begin = axis.homed = axis.reports_motion = false;
    axis.busy = true;
    axis.cleared = !clearing();
    axis.stalls = axis.lists = 0;
    axis.last_list.clear();
    if (lost) axis.lists_required = 2;
    if (clearing()) axis.settings.clear();  // they may have been the cause
  }
}

/// Clears faults, lists the warnings and reads every axis at rest, then reads the settings.
bool ZaberDriver::nextOfSession() {
  if (settled_) return false;
  for (int i = 0; i < 3; ++i) {
    if (nextOfAxis(i)) return true;
  }
  if (nextOfHoming()) return true;
  if (nextOfSettings()) return true;
  if (const std::string wrong = checkSettings(); !wrong.empty()) return raiseFault(wrong), true;
  adaptToReplyTime();
  // The homing of another axis takes long.
  for (int i = 0; i < 3; ++i) {
    if (activeTime() - axes_[i].last_read > turnTime()) return request(Kind::kPosition, i, "get pos"), true;
  }
  settled_ = true;
  may_home_ = false;
  confirmPositions();
  return false;
}

bool ZaberDriver::nextOfAxis(int i) {
  Axis& axis = axes_[i];
  if (!axis.cleared) return request(Kind::kClear, i, "warnings clear"), true;
  // While homing it has no reference yet; the list must be read afterwards.
  if (axis.lists_required > 0 && !(axis.homed && axis.busy)) return request(Kind::kWarnings, i, "warnings"), true;
  // It is braking, or did not receive the session's stop.
  if (axis.reports_motion && !axis.homed) return request(Kind::kStop, i, "stop"), true;
  if (!axis.busy && !axis.has_reference) return false;  // its position is invalid; see nextOfHoming
  if (axis.read_since_begin && !axis.busy && !axis.filter.isImplausible()) return false;
  if (activeTime() - begun_ > (axis.homed ? kLongestHoming : kLongestBraking)) {
    exchangeFailed(axisName(i) + (axis.busy ? " does not come to rest" : " has no steady position"));
  } else {
    request(Kind::kPosition, i, "get pos");
  }
  return true;
}

/// Reads the devices' settings, once per connection and when a fault is cleared.
bool ZaberDriver::nextOfSettings() {
  for (int i = 0; i < 3; ++i) {
    const auto missing = axes_[i].settings.missing();
    if (!missing) continue;
    const std::string command = ZaberSettings::command(*missing);
    if (++setting_tries_ > kSettingTries) {
      exchangeFailed(axisName(i) + " gives no valid reply to \"" + command + "\"");
    } else {
      request(Kind::kSetting, i, command, *missing);
    }
    return true;
  }
  return false;
}

void ZaberDriver::handleSetting(const Exchange& request, const std::string& data) {
  const auto name = static_cast<ZaberSettings::Name>(request.value);
  if (!ZaberSettings::ofDevice(name)) return axes_[request.axis].settings.add(name, data);
  for (int i = 0; i < 3; ++i) {
    if (config_.addresses[i].device == request.to.device) axes_[i].settings.add(name, data);
  }
}

/// Returns the reason why the device differs from the file's description, else an empty text.
std::string ZaberDriver::settingsMismatch(int i) const {
  const ZaberSettings& settings = axes_[i].settings;
  const double unit = config_.microsteps_per_metre[i] * kAccelUnit;  // for 1 m/s^2
  for (const auto name : {ZaberSettings::kAcceleration, ZaberSettings::kDeceleration}) {
    const auto data = settings.number(name);
    if (!data) continue;
    const double reported = static_cast<double>(*data) / unit;
    if (std::abs(reported - config_.acceleration) <= kAgreement * config_.acceleration) continue;
    return axisName(i) + ": acceleration = " + text(config_.acceleration) +
           " m/s^2 in the file: must be within a tenth of the device's, which is " + text(reported) + " m/s^2 (\"" +
           ZaberSettings::command(name) + "\" says " + std::to_string(*data) + "); change either";
  }
  const auto resolution = settings.number(ZaberSettings::kResolution);
  if (config_.resolution == 0 || !resolution || *resolution == config_.resolution) return "";
  return axisName(i) + ": resolution = " + std::to_string(config_.resolution) +
         " in the file: must be the device's, which is " + std::to_string(*resolution) +
         " microsteps a full step; microsteps_per_metre changes with it";
}

/// Uses the acceleration of the devices. Returns what is wrong with their settings, else an empty
/// text.
std::string ZaberDriver::checkSettings() {
  double slowest = config_.acceleration * (1 + kAgreement);  // m/s^2
  for (int i = 0; i < 3; ++i) {
    const std::string wrong = settingsMismatch(i);
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

/// Adapts turn, gain and time-outs to the measured reply time. After a mere stop it is still valid.
void ZaberDriver::adaptToReplyTime() {
  const auto measured = reply_times_.measured();
  if (!lost_ || !measured) return;
  answer_time_ = std::max(config_.answer_time, *measured);
  const double wire = (kZaberCommandBytes + kZaberReplyBytes) * config_.byteTime();
  waitForSilence(answer_time_ + 60 * config_.byteTime() + 5e-3,
                 std::max(config_.reply_timeout, 3 * answer_time_) + wire);
}

/// Sends the next request of homing. Returns false if there is none.
bool ZaberDriver::nextOfHoming() {
  const auto lacks = [](const Axis& axis) { return !axis.has_reference; };
  const auto lacking = std::find_if(axes_.begin(), axes_.end(), lacks);
  const bool begun = std::any_of(axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.homed; });
  if (lacking == axes_.end() && !begun) return false;
  const int first = static_cast<int>(lacking - axes_.begin());
  if (state() == State::kFault && !clearing()) {  // no position is reported
    request(Kind::kWarnings, lacking == axes_.end() ? 0 : first, "warnings");
    return true;
  }
  // Neither clearing a fault nor switching the device off and on is permission to move.
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

/// A stopped homing must not start again.
void ZaberDriver::onStopCommand() {
  if (std::any_of(axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.homed; })) may_home_ = false;
}

void ZaberDriver::home(int i) {
  Axis& axis = axes_[i];
  movesByItself();
  axis.position.reset();  // its counts begin anew
  axis.read_since_begin = false;
  axis.lists_required = 1;
  begun_ = activeTime();
  request(Kind::kHome, i, "home");
}

}  // namespace microinjection
