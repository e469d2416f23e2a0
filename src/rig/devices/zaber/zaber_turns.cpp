// ZaberDriver: sends the next command, for a move and in turn.

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "rig/devices/zaber/zaber_driver.h"

namespace microinjection {
namespace {

constexpr double kVelocityHolds = 0.1;  // s, for which the velocity of a set-point is followed
constexpr int kMoveTries = 2;
constexpr long long kSlowestArrival = 16;  // units of speed, about 10 microsteps/s
constexpr double kSlowestAxis = 10;        // microsteps/s, of an axis in a move
constexpr double kShortestMove = 3;  // microsteps, of a velocity; for an axis that is ahead a shorter one may be none

}  // namespace

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

}  // namespace microinjection
