#include "hardware/devices/zaber/zaber_driver.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace microinjection {
namespace {

constexpr double kLongestExtrapolation = 0.2;  // s, for which an extrapolated position is meaningful
constexpr double kSlowReplies = 2;             // times the expected time, from which slow replies are reported

std::string stopAll(const ZaberConfig& config) {
  std::string bytes;
  for (const ZaberAddress& address : config.addresses) bytes += zaberCommand(address, "stop", config.checksum);
  return bytes;
}

bool hasZaberReply(const std::string& answer) {
  const std::vector<ZaberMessage> messages = ZaberParser(false).feed(answer);
  return std::any_of(messages.begin(), messages.end(),
                     [](const ZaberMessage& message) { return message.kind == ZaberMessage::Kind::kReply; });
}

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

constexpr double kVelocityHolds = 0.1;  // s, for which the velocity of a set-point is followed
constexpr int kMoveTries = 2;
constexpr long long kSlowestArrival = 16;  // units of speed, about 10 microsteps/s
constexpr double kSlowestAxis = 10;        // microsteps/s, of an axis in a move
constexpr double kShortestMove = 3;  // microsteps, of a velocity; for an axis that is ahead a shorter one may be none

constexpr double kRetryPause = 0.02;  // s, after AGAIN and similar rejections
constexpr int kTries = 3;             // of a message
constexpr int kStalls = 10;           // readings of an axis at rest that should move
constexpr int kMostLists = 20;        // of warnings, without a position between them

}  // namespace

ZaberDriver::ZaberDriver(const ZaberConfig& config, std::unique_ptr<Wire> wire)
    : SerialManipulator(std::move(wire),
                        {"Zaber", stopAll(config), config.answer_time + 60 * config.byteTime() + 5e-3,
                         config.reply_timeout + (kZaberCommandBytes + kZaberReplyBytes) * config.byteTime(), "", "#"}),
      config_(config),
      parser_(config.reply_checksum),
      answer_time_(config.answer_time),
      acceleration_(config.acceleration),
      may_home_(config.home) {
  // The empty command: no letter that another device could take for one of its own.
  askFirst({"/\n", hasZaberReply, "a Zaber", config.reply_timeout});
}

double ZaberDriver::gain() const {
  // A loop with a dead time T is well damped up to a gain of about 0.4 / T; a turn has six
  // exchanges.
  return config_.gain > 0 ? config_.gain : 0.3 / (7 * exchangeTime());
}

/// Time (s) after which a motion ends unless renewed; longer than in the file if the line is slow.
double ZaberDriver::horizon() const {
  return std::max(config_.move_horizon, 1.1 * config_.leastHorizon(turnTime(), acceleration_));
}

/// Includes one exchange for the list of an axis with a warning.
double ZaberDriver::turnTime() const {
  const bool warns = std::any_of(axes_.begin(), axes_.end(), [](const Axis& axis) { return !axis.shown_flag.empty(); });
  return (kZaberTurn + (warns ? 1 : 0)) * exchangeTime();
}

/// Maximum age (s) of a position: two turns, one missing reply, and a stop, in which an axis is
/// polled alone.
double ZaberDriver::longestAge() const {
  return 2 * turnTime() + config_.reply_timeout + answer_time_ + config_.speed / acceleration_;
}

double ZaberDriver::longestExtrapolation() const { return std::max(kLongestExtrapolation, 1.3 * turnTime()); }

/// Limited to the speed from which the axis can brake in the distance at which it is slowed down.
double ZaberDriver::fastest(int i) const { return std::min({config_.speed, speedLimits()[i], acceleration_ / gain()}); }

/// Device data of a speed (m/s), never above the axis' fastest.
long long ZaberDriver::speedData(int i, double speed) const {
  const double unit = config_.microsteps_per_metre[i] * kZaberSpeedUnit;
  const auto most = static_cast<long long>(fastest(i) * unit);
  return std::clamp(std::llround(speed * unit), -most, most);
}

ManipulatorAbilities ZaberDriver::abilities() const {
  ManipulatorAbilities abilities;
  abilities.device = "Zaber (ASCII protocol" + axesNote() + ")";
  abilities.follows = true;
  abilities.command_interval = abilities.reading_interval = turnTime();
  abilities.resolution = 1 / config_.microsteps_per_metre.minCoeff();
  abilities.speed = std::min(config_.speed, speedLimits().maxCoeff());
  abilities.latency = 4 * exchangeTime();  // half a turn of waiting, and its own transmission
  const double wire = stopAll(config_).size() * config_.byteTime();
  abilities.stop_time = wire + answer_time_ + abilities.speed / acceleration_;
  return abilities;
}

/// Properties of the connected devices that concern an operator.
std::string ZaberDriver::axesNote() const {
  std::string note;
  if (std::any_of(axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.settings.oldFirmware(); })) {
    note += "; firmware before 7.25, a velocity does not end by itself";
  }
  if (answer_time_ > kSlowReplies * config_.answer_time) {
    note += "; answers take " + std::to_string(std::lround(1e3 * answer_time_)) +
            " ms: lower the latency timer of the serial adapter";
  }
  return note;
}

std::string ZaberDriver::note() const {
  std::string note;
  for (int i = 0; i < 3; ++i) {
    if (axes_[i].shown_flag.empty()) continue;
    note += (note.empty() ? "" : ", ") + axisName(i) + " warns " + axes_[i].shown_flag;
  }
  return note;
}

double ZaberDriver::expected(int i, double at) const {
  const Axis& axis = axes_[i];
  if (!axis.position) return std::nan("");
  const double travel = axis.velocity * std::max(0.0, at - axis.position_time);
  if (std::isnan(axis.end)) return *axis.position + travel;
  const double left = axis.end - *axis.position;
  return *axis.position + (std::abs(travel) < std::abs(left) ? travel : left);  // never past the end of the move
}

std::optional<ManipulatorDevice::Reading> ZaberDriver::reading() const {
  Eigen::Vector3d device, velocity;
  for (int i = 0; i < 3; ++i) {
    if (!axes_[i].position || !axes_[i].has_reference || !positionsValid()) return std::nullopt;
    device[i] = expected(i, time());
    velocity[i] = !std::isnan(axes_[i].end) && device[i] == axes_[i].end ? 0 : axes_[i].velocity;
  }
  return Reading{config_.joints.toJoints(device), config_.joints.directions.cwiseProduct(velocity)};
}

bool ZaberDriver::moving() const {
  if (!goal()) return std::any_of(axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.busy; });
  if (!goal()->follows) return !move_done_;
  const Eigen::Vector3d wanted = config_.joints.toDevice(goal()->joints);
  for (int i = 0; i < 3; ++i) {
    const double away = std::abs(wanted[i] - axes_[i].position.value_or(wanted[i]));
    if (axes_[i].sent_velocity.value_or(1) != 0 || away > 1 / config_.microsteps_per_metre[i]) return true;
    if (axes_[i].busy || !axes_[i].read_since_command || axes_[i].filter.isImplausible()) return true;
  }
  return false;
}

void ZaberDriver::goalChanged() {
  move_stage_ = move_tries_ = 0;
  move_done_ = false;
}

void ZaberDriver::exchange(const std::string& bytes) {
  for (const ZaberMessage& message : parser_.feed(bytes)) {
    handle(message);
    if (!exchanging()) return;
  }
  if (exchange_ && activeTime() > exchange_->due) exchange_->sent ? missedReply() : sendExchange();
  if (!exchange_ && exchanging()) next();
}

int ZaberDriver::axisOf(const ZaberAddress& address) const {
  const auto found = std::find(config_.addresses.begin(), config_.addresses.end(), address);
  return found == config_.addresses.end() ? -1 : static_cast<int>(found - config_.addresses.begin());
}

std::string ZaberDriver::axisName(int axis) const {
  const ZaberAddress& address = config_.addresses[axis];
  return "axis " + std::to_string(address.axis) + " of device " + std::to_string(address.device);
}

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

void ZaberDriver::next() {
  if (nextOfWarnings() || nextOfSession()) return;
  if (goal() && !goal()->follows && nextOfMove()) return;
  nextInTurn();
}

/// Lists the warnings of an axis whose flag may hide a lost reference position.
bool ZaberDriver::nextOfWarnings() {
  for (int i = 0; i < 3; ++i) {
    if (settled_ && axes_[i].lists_required > 0) return request(Kind::kWarnings, i, "warnings"), true;
  }
  return false;
}

bool ZaberDriver::goalAtRest() const { return goal()->velocity.isZero(0) || time() - goal()->time >= kVelocityHolds; }

long long ZaberDriver::velocityData(int i) const {
  const Eigen::Vector3d wanted = config_.joints.toDevice(goal()->joints);
  Eigen::Vector3d velocity = config_.joints.directions.cwiseProduct(goal()->velocity) * (goalAtRest() ? 0 : 1);
  const double away = wanted[i] - expected(i, time());
  if (velocity[i] == 0 && std::abs(away) * config_.microsteps_per_metre[i] < 0.75) return 0;
  // A move to a position ends there by itself. Control by velocities alone must not oscillate.
  const double rate = goalAtRest() && axes_[i].settings.movesHaveSpeeds() ? 1 / turnTime() : gain();
  double share = 1;  // all axes are slowed down together, so that a long path stays straight
  for (int k = 0; k < 3; ++k) {
    velocity[k] += rate * (wanted[k] - expected(k, time()));
    if (std::abs(velocity[k]) > fastest(k)) share = std::min(share, fastest(k) / std::abs(velocity[k]));
  }
  return speedData(i, share * velocity[i]);
}

/// End (microsteps) of a velocity unless it is renewed. Empty if the axis must rest, the device
/// cannot do it, or the end of travel is nearer.
std::optional<long long> ZaberDriver::endOfVelocity(int i, long long data) const {
  if (data == 0) return std::nullopt;
  const double distance = std::max(std::abs(data / kZaberSpeedUnit) * horizon(), kShortestMove);
  const double from = expected(i, time()) * config_.microsteps_per_metre[i];
  const long long end = std::llround(from + std::copysign(distance, static_cast<double>(data)));
  return canGoTo(i, end) ? std::optional(end) : std::nullopt;
}

/// Position (microsteps) of a resting set-point that is so near that the device may move there
/// without renewal, which prevents overshoot. Empty if the set-point moves or is far, the device
/// cannot do it, or the position is outside.
std::optional<long long> ZaberDriver::arrivalPosition(int i) const {
  if (!goalAtRest()) return std::nullopt;
  const double wanted = config_.joints.toDevice(goal()->joints)[i];
  const long long position = std::llround(wanted * config_.microsteps_per_metre[i]);
  const bool near = std::abs(wanted - expected(i, time())) <= fastest(i) * horizon();
  return near && canGoTo(i, position) ? std::optional(position) : std::nullopt;
}

bool ZaberDriver::canGoTo(int i, long long position) const {
  const ZaberSettings& settings = axes_[i].settings;
  const auto lowest = settings.number(ZaberSettings::kLowest), highest = settings.number(ZaberSettings::kHighest);
  return settings.movesHaveSpeeds() && lowest && highest && position >= *lowest && position <= *highest;
}

/// Sends a velocity that is new or must be renewed.
bool ZaberDriver::nextVelocity(int i) {
  if (!goal() || !goal()->follows || !mayMove() || !axes_[i].position) return false;
  long long data = velocityData(i);
  std::optional<long long> end = arrivalPosition(i);
  if (end && axes_[i].sent_velocity.value_or(0) != 0 &&
      axes_[i].end == static_cast<double>(*end) / config_.microsteps_per_metre[i]) {
    return false;  // already moving there
  }
  if (end && data != 0) data = std::copysign(std::max(std::llabs(data), kSlowestArrival), data);
  if (!end) end = endOfVelocity(i, data);
  if (end && data != 0) {
    request(Kind::kVelocity, i, "move abs " + std::to_string(*end) + " " + std::to_string(std::abs(data)), data,
            static_cast<double>(*end) / config_.microsteps_per_metre[i]);
    return true;
  }
  if (axes_[i].sent_velocity == data && std::isnan(axes_[i].end)) return false;
  request(Kind::kVelocity, i, "move vel " + std::to_string(data), data);
  return true;
}

void ZaberDriver::nextInTurn() {
  const int i = turn_ / 2;
  if (turn_ % 2 == 0) {
    turn_ = turn_ + 1;
    if (nextVelocity(i)) return;
  }
  turn_ = (turn_ + 1) % 6;
  if (turn_ == 0) requestWarningsAgain();
  request(Kind::kPosition, i, "get pos");
}

/// A persistent warning may hide a new one. Once per turn an axis with a warning is asked for all
/// of them.
void ZaberDriver::requestWarningsAgain() {
  for (int k = 0; k < 3; ++k) {
    last_listed_ = (last_listed_ + 1) % 3;
    if (axes_[last_listed_].shown_flag.empty()) continue;
    axes_[last_listed_].lists_required = 1;
    return;
  }
}

long long ZaberDriver::moveSpeedData(int i) const {
  const Eigen::Vector3d end = config_.joints.toDevice(goal()->joints);
  Eigen::Vector3d displacement;
  for (int k = 0; k < 3; ++k) displacement[k] = end[k] - expected(k, time());
  const double share = displacement.norm() > 0 ? std::abs(displacement[i]) / displacement.norm() : 1;
  return std::max(1LL, speedData(i, std::max(goal()->speed * share, kSlowestAxis / config_.microsteps_per_metre[i])));
}

/// Sends the speeds and ends of a move one by one, then monitors it. A move's own speed is not
/// written to the device's memory, unlike its setting.
bool ZaberDriver::nextOfMove() {
  if (move_done_ || !mayMove()) return false;
  for (; move_stage_ < 3; ++move_stage_) {
    const int i = move_stage_;
    const long long data = moveSpeedData(i);
    if (!axes_[i].settings.movesHaveSpeeds())
      return request(Kind::kSpeed, i, "set maxspeed " + std::to_string(data), data), true;
    axes_[i].move_speed = static_cast<double>(data) / (config_.microsteps_per_metre[i] * kZaberSpeedUnit);
  }
  if (move_stage_ >= 6) {
    checkMove();
    return !exchanging();
  }
  const int i = move_stage_ - 3;
  const double scale = config_.microsteps_per_metre[i];
  const long long end = std::llround(config_.joints.toDevice(goal()->joints)[i] * scale);
  std::string command = "move abs " + std::to_string(end);
  if (axes_[i].settings.movesHaveSpeeds()) {
    command += " " + std::to_string(std::llround(axes_[i].move_speed * scale * kZaberSpeedUnit));
  }
  request(Kind::kMove, i, command, end);
  return true;
}

void ZaberDriver::checkMove() {
  for (const Axis& axis : axes_) {
    if (axis.busy || !axis.read_since_command || axis.filter.isImplausible()) return;
  }
  const Eigen::Vector3d wanted = config_.joints.toDevice(goal()->joints);
  for (int i = 0; i < 3; ++i) {
    if (std::abs(wanted[i] - *axes_[i].position) * config_.microsteps_per_metre[i] < 1.5) continue;
    if (++move_tries_ >= kMoveTries) return raiseFault(axisName(i) + " does not arrive: the move was interrupted");
    move_stage_ = 0;  // to the same position; completed parts are not repeated
    return;
  }
  move_done_ = true;
  for (Axis& axis : axes_) axis.velocity = 0;
}

void ZaberDriver::request(Kind kind, int axis, const std::string& command, long long value, double end) {
  ZaberAddress to = config_.addresses[axis];
  if (kind == Kind::kSetting && ZaberSettings::ofDevice(static_cast<ZaberSettings::Name>(value))) to.axis = 0;
  exchange_ = Exchange{kind, axis, to, value, end, command, 0, 0, false, 0, 0};
  sendExchange();
}

/// Until the reply time is measured, each try waits longer.
void ZaberDriver::sendExchange() {
  std::optional<int> number;
  if (config_.numbers) number = number_ = (number_ + 1) % 100;
  const std::string bytes = zaberCommand(exchange_->to, exchange_->text, config_.checksum, number);
  const double wire = static_cast<double>(bytes.size()) * config_.byteTime();
  const double timeout = std::max(config_.reply_timeout, 3 * answer_time_);
  ++exchange_->tries;
  exchange_->sent = true;
  exchange_->delivered_time = time() + wire;
  exchange_->delivered_active_time = activeTime() + wire;
  exchange_->due = exchange_->delivered_active_time + kZaberReplyBytes * config_.byteTime() +
                   timeout * (settled_ ? 1 : exchange_->tries);
  send(bytes);
}

/// Whether it is the reply to the last request. The device itself rejects requests to an axis that
/// it does not have.
bool ZaberDriver::isExpectedReply(const ZaberMessage& reply) const {
  if (!exchange_ || !exchange_->sent || (config_.numbers && reply.number != number_)) return false;
  const ZaberAddress device{exchange_->to.device, 0};
  return reply.from == exchange_->to || (reply.rejected && reply.from == device);
}

/// A command is answered once. What a line that doubles bytes repeats is the same.
bool ZaberDriver::isOfTwin(const ZaberMessage& reply) {
  if (!answer_ || !answer_->number || reply.number != answer_->number || !(reply.from == answer_->from)) return false;
  if (reply.rejected == answer_->rejected && reply.data == answer_->data) return false;
  if (state() == State::kFault && !clearing()) return true;
  const std::string device = std::to_string(reply.from.device);
  raiseFault("one command has two answers of device " + device + ", \"" + answer_->data + "\" and \"" + reply.data +
             "\": two devices have the address " + device + ", and both would move. Connect them one by one and give " +
             "each an address of its own (set comm.address, or /renumber)");
  return true;
}

void ZaberDriver::handle(const ZaberMessage& message) {
  const int axis = axisOf(message.from);
  if (message.kind == ZaberMessage::Kind::kReply) {
    if (isOfTwin(message)) return;
    if (!isExpectedReply(message)) return;
    answer_ = message;
    handleReply(message);
  } else if (message.kind == ZaberMessage::Kind::kAlert && axis >= 0) {
    handleFlag(message.flag, axis);
  }
}

/// Handles the flag of a reply, which is the most important one.
void ZaberDriver::handleFlag(const std::string& flag, int i) {
  const bool already_reported = state() == State::kFault && !clearing();
  if (isZaberFault(flag)) {
    if (!already_reported) raiseFault(axisName(i) + " reports fault " + flag);
    return;
  }
  if (flag == kZaberNoReference) return loseReference(i);
  Axis& axis = axes_[i];
  if (!mayHideZaberReference(flag)) {
    axis.has_reference = true;  // WR would be shown
    axis.shown_flag.clear();
  } else if (flag != axis.shown_flag) {
    axis.lists_required = std::max(axis.lists_required, 1);
  }
}

/// At the start of a session homing may be allowed. Later the device was switched off, or its
/// encoder has failed, and its counts are no position.
void ZaberDriver::loseReference(int i) {
  axes_[i].has_reference = false;
  if (!settled_ || state() == State::kFault) return;
  raiseFault(axisName(i) + " has lost its reference position (WR): was it switched off? Home it");
}

void ZaberDriver::handleWarnings(const Exchange& request, const ZaberMessage& reply) {
  Axis& axis = axes_[request.axis];
  const bool already_reported = state() == State::kFault && !clearing();
  if (!already_reported && ++axis.lists > kMostLists) {
    return raiseFault(axisName(request.axis) + ": its warnings do not stay the same, the last are \"" + reply.data +
                      "\": behind them a lost reference position could hide");
  }
  const bool twice = axis.last_list == reply.data;
  axis.last_list = reply.data;
  if (axis.lists_required > 1 || (!twice && !settled_)) {
    axis.lists_required = 1;  // a damaged list could let a needle without reference move
    return;
  }
  axis.lists_required = 0;
  axis.last_list.clear();
  axis.shown_flag = mayHideZaberReference(reply.flag) ? reply.flag : "";
  bool referenced = reply.flag != kZaberNoReference;
  const std::vector<std::string> flags = reply.flags().value_or(std::vector<std::string>());
  for (const std::string& flag : flags) {
    referenced = referenced && flag != kZaberNoReference;
    if (!isZaberFault(flag)) continue;
    handleFlag(flag, request.axis);
    if (!exchanging()) return;
  }
  if (!referenced) return loseReference(request.axis);
  axis.has_reference = true;
}

void ZaberDriver::handleReply(const ZaberMessage& reply) {
  const Exchange done = *exchange_;
  if (reply.rejected) return handleRejection(reply);
  // A late reply to another request; the expected one is still to come.
  if (done.kind == Kind::kPosition && !reply.position()) return;
  if (done.kind == Kind::kWarnings && !reply.flags()) return;
  if (!settled_ && (config_.numbers || done.tries == 1)) {
    reply_times_.add(activeTime() - done.delivered_active_time - static_cast<double>(reply.size) * config_.byteTime());
  }
  exchangeSucceeded();
  exchange_.reset();
  if (done.kind == Kind::kSetting) return handleSetting(done, reply.data);
  if (done.kind == Kind::kWarnings) return handleWarnings(done, reply);
  if (done.kind != Kind::kClear) handleFlag(reply.flag, done.axis);
  if (exchanging()) applyReply(done, reply);
}

void ZaberDriver::applyReply(const Exchange& done, const ZaberMessage& reply) {
  Axis& axis = axes_[done.axis];
  axis.busy = reply.busy;
  const double speed_unit = config_.microsteps_per_metre[done.axis] * kZaberSpeedUnit;  // for 1 m/s
  switch (done.kind) {
    case Kind::kPosition:
      axis.reports_motion = reply.busy;
      if (!axis.has_reference || axis.lists_required > 0) break;
      axis.lists = 0;
      handlePosition(done, reply);
      break;
    case Kind::kVelocity:
      axis.position = expected(done.axis, time());
      axis.position_time = time();
      axis.velocity = done.value / speed_unit;
      axis.end = done.end;
      axis.sent_velocity = done.value;
      axis.read_since_command = false;
      break;
    case Kind::kMove:
      axis.position = expected(done.axis, time());
      axis.position_time = time();
      axis.end = done.value / config_.microsteps_per_metre[done.axis];
      axis.velocity = std::copysign(axis.move_speed, axis.end - *axis.position);
      axis.sent_velocity.reset();
      axis.read_since_command = false;
      ++move_stage_;
      break;
    case Kind::kSpeed:
      axis.move_speed = done.value / speed_unit;
      ++move_stage_;
      break;
    case Kind::kClear:
      axis.cleared = true;
      break;
    case Kind::kStop:
      axis.reports_motion = false;  // until it reports motion
      break;
    case Kind::kHome:
      axis.homed = axis.busy = true;
      break;
    case Kind::kWarnings:
    case Kind::kSetting:
      break;  // handled before
  }
}

void ZaberDriver::handleRejection(const ZaberMessage& reply) {
  const Exchange refused = *exchange_;
  if (reply.from == refused.to && refused.kind != Kind::kSetting) handleFlag(reply.flag, refused.axis);
  if (!exchanging()) return;
  // The device is busy, or the command was damaged. A rejected command had no effect and may be
  // repeated.
  const bool later = reply.data == "AGAIN" || reply.data == "STATUSBUSY" || reply.data == "FULL";
  const bool damaged = reply.data == "BADCOMMAND";
  if ((later || damaged) && refused.tries < kTries) {
    exchange_->sent = false;
    exchange_->due = activeTime() + kRetryPause;
    return;
  }
  const auto setting = static_cast<ZaberSettings::Name>(refused.value);
  if (refused.kind == Kind::kSetting && damaged && ZaberSettings::mayBeUnknown(setting)) {
    exchange_.reset();
    return axes_[refused.axis].settings.setUnsupported(setting);
  }
  raiseFault(axisName(refused.axis) + " refuses \"" + refused.text + "\": " + reply.data);
}

void ZaberDriver::handlePosition(const Exchange& request, const ZaberMessage& reply) {
  const int i = request.axis;
  Axis& axis = axes_[i];
  const double position = *reply.position() / config_.microsteps_per_metre[i];
  // The reading was taken soon after the device received the command. A slow adapter delays only
  // the reply.
  const double then = std::min(request.delivered_time + config_.answer_time / 2,
                               time() - static_cast<double>(reply.size) * config_.byteTime());
  const double extrapolated = expected(i, then);
  const double step = 1 / config_.microsteps_per_metre[i];
  const double since = std::clamp(time() - axis.position_time, 0.0, longestExtrapolation()) + exchangeTime();
  const bool rests = !reply.busy && axis.velocity == 0;
  const double tolerance =
      rests ? std::max(2.5 * step, axis.coasting) : config_.reading_margin + std::abs(axis.velocity) * since;
  const double agreement = reply.busy ? config_.reading_margin / 2 + config_.speed * turnTime() : 2.5 * step;
  using Coordinate = Eigen::VectorXd;
  if (!axis.filter.accept(Coordinate::Constant(1, position), Coordinate::Constant(1, extrapolated), tolerance,
                          agreement))
    return;
  const bool unchanged = axis.position && std::abs(position - *axis.position) < 0.5 * step;
  if (!reply.busy) axis.coasting = 0;
  axis.position = position;
  axis.position_time = then;
  axis.last_read = activeTime();
  validityTime(std::min({axes_[0].last_read, axes_[1].last_read, axes_[2].last_read}) + longestAge() - activeTime());
  axis.read_since_begin = axis.read_since_command = true;
  if (!reply.busy && axis.sent_velocity.value_or(0) != 0) return checkStall(i, unchanged);
  axis.stalls = 0;
}

/// An axis that rests despite a velocity has stopped by itself or was stopped by hand. The velocity
/// is repeated a few times.
void ZaberDriver::checkStall(int i, bool unchanged) {
  Axis& axis = axes_[i];
  axis.sent_velocity.reset();
  axis.velocity = 0;
  axis.stalls = unchanged ? axis.stalls + 1 : 0;
  if (axis.stalls >= kStalls) raiseFault(axisName(i) + " does not move at the commanded velocity; is it at its end?");
}

void ZaberDriver::missedReply() {
  // Positions, speeds and absolute moves may be repeated; the effect of a late reply is checked
  // elsewhere.
  if (exchange_->tries < kTries) return sendExchange();
  const std::string unchecked = parser_.unchecked() > 0 ? "; replies came without a checksum: set the device's "
                                                          "comm.checksum to 1, or reply_checksum to false"
                                                        : "";
  const Exchange lost = *exchange_;
  exchangeFailed("no reply of " + axisName(lost.axis) + " to \"" + lost.text + "\"" + unchecked);
}

}  // namespace microinjection
