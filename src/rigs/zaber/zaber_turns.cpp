// What ZaberDriver says next: at the begin of a session, for a move, and in turn.

#include <algorithm>
#include <cmath>
#include <utility>

#include "rigs/zaber/zaber_driver.h"

namespace microinjection {
namespace {

constexpr double kVelocityHolds = 0.1;   // s: a set-point's velocity is not followed for longer
constexpr double kLongestBraking = 1.5;  // s, after a stop
constexpr double kLongestHoming = 120;   // s
constexpr int kMoveTries = 2;
constexpr double kSlowest = 10;     // microsteps/s, of an axis of a move
constexpr double kShortestWay = 3;  // microsteps, of a velocity: a shorter one may be none for an axis that is ahead
constexpr int kSettingTries = 40;   // of nine settings that are told twice each

}  // namespace

void ZaberDriver::next() {
  if (nextOfSession()) return;
  if (goal() && !goal()->follows && nextOfMove()) return;
  nextInTurn();
}

/// At the begin of a session: faults are cleared, and every axis must have been read and be at rest.
bool ZaberDriver::nextOfSession() {
  if (settled_) return false;
  for (int i = 0; i < 3; ++i) {
    Axis& axis = axes_[i];
    if (!axis.cleared) return ask(Kind::kClear, i, "warnings clear"), true;
    // Braking, or the session's stop did not reach it.
    if (axis.still_moves && !axis.homed) return ask(Kind::kStop, i, "stop"), true;
    if (!axis.read_since_begin || axis.busy || axis.filter.doubts()) {
      if (listened() - begun_ > (axis.homed ? kLongestHoming : kLongestBraking)) {
        lostStep(axisName(i) + (axis.busy ? " does not come to rest" : " has no steady position"));
      } else {
        ask(Kind::kPosition, i, "get pos");
      }
      return true;
    }
  }
  if (nextOfHoming()) return true;
  if (nextOfSettings()) return true;
  // Another axis' homing takes long.
  for (int i = 0; i < 3; ++i) {
    if (listened() - axes_[i].heard > abilities().reading_interval) return ask(Kind::kPosition, i, "get pos"), true;
  }
  settled_ = true;
  may_home_ = false;
  known();
  return false;
}

/// What the device can do, asked once for a connection. It counts when it is told twice: a damaged answer would last.
bool ZaberDriver::nextOfSettings() {
  for (int i = 0; i < 3; ++i) {
    const Axis& axis = axes_[i];
    const bool has_speeds = axis.moves_have_speeds.value_or(false);
    if (axis.moves_have_speeds && (!has_speeds || (axis.lowest && axis.highest))) continue;
    if (++setting_tries_ > kSettingTries) {
      lostStep(axisName(i) + " tells no firmware version or no travel");
    } else if (!axis.moves_have_speeds) {
      ask(Kind::kVersion, i, "get version");
    } else if (!axis.lowest) {
      ask(Kind::kLowest, i, "get limit.min");
    } else {
      ask(Kind::kHighest, i, "get limit.max");
    }
    return true;
  }
  return false;
}

void ZaberDriver::takeSetting(const Exchange& asked, const ZaberMessage& reply) {
  const bool twice = std::exchange(setting_, reply.data) == reply.data;
  if (!twice) return;
  setting_.clear();
  Axis& axis = axes_[asked.axis];
  if (asked.kind == Kind::kLowest) axis.lowest = reply.position();
  if (asked.kind == Kind::kHighest) axis.highest = reply.position();
  for (int i = 0; i < 3 && asked.kind == Kind::kVersion; ++i) {
    if (config_.addresses[i].device == asked.to.device) axes_[i].moves_have_speeds = zaberMovesHaveSpeeds(reply.data);
  }
}

/// What looking for the reference positions needs next; false: nothing.
bool ZaberDriver::nextOfHoming() {
  const auto lacks = [](const Axis& axis) { return !axis.has_reference; };
  const auto lacking = std::find_if(axes_.begin(), axes_.end(), lacks);
  const bool begun = std::any_of(axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.homed; });
  if (lacking == axes_.end() && !begun) return false;
  if (state() == State::kFault && !clearing()) return false;
  // Neither a cleared fault nor a device that was switched off and on is leave to move.
  const bool may = may_home_ && !clearing() && homing_.refusal.empty();
  if (lacking != axes_.end() && (!may || lacking->homed)) {
    const std::string way = homing_.refusal.empty() ? "home it, by its maker's tool or by home: true at the start"
                                                    : "home: true is refused, " + homing_.refusal;
    raiseFault(axisName(static_cast<int>(lacking - axes_.begin())) + " has no reference position: " + way);
    return true;
  }
  for (const int i : homing_.order) {
    if (axes_[i].homed) continue;
    if (!may) return false;
    movesByItself();
    axes_[i].position.reset();  // its numbers begin anew
    axes_[i].read_since_begin = false;
    begun_ = listened();
    ask(Kind::kHome, i, "home");
    return true;
  }
  return false;
}

long long ZaberDriver::velocityData(int i) const {
  const Eigen::Vector3d wanted = config_.joints.toDevice(goal()->joints);
  const bool fresh = time() - goal()->time < kVelocityHolds;
  Eigen::Vector3d velocity = config_.joints.directions.cwiseProduct(goal()->velocity) * (fresh ? 1 : 0);
  const double away = wanted[i] - expected(i, time());
  if (velocity[i] == 0 && std::abs(away) * config_.microsteps_per_metre[i] < 0.75) return 0;
  double share = 1;  // all axes are slowed down together, so that a long way stays straight
  for (int k = 0; k < 3; ++k) {
    velocity[k] += gain() * (wanted[k] - expected(k, time()));
    if (std::abs(velocity[k]) > fastest(k)) share = std::min(share, fastest(k) / std::abs(velocity[k]));
  }
  return speedData(i, share * velocity[i]);
}

/// Where (microsteps) a velocity ends unless it is renewed. Empty: the axis is to stand, the device cannot, or the end
/// of its travel is nearer.
std::optional<long long> ZaberDriver::endOfVelocity(int i, long long data) const {
  const Axis& axis = axes_[i];
  if (data == 0 || !axis.moves_have_speeds.value_or(false)) return std::nullopt;
  const double way = std::max(std::abs(data / kZaberSpeedUnit) * config_.move_horizon, kShortestWay);
  const double from = expected(i, time()) * config_.microsteps_per_metre[i];
  const long long end = std::llround(from + std::copysign(way, static_cast<double>(data)));
  if (end < *axis.lowest || end > *axis.highest) return std::nullopt;
  return end;
}

/// A velocity that is new, or that has to be renewed.
bool ZaberDriver::nextVelocity(int i) {
  if (!goal() || !goal()->follows || !mayMove() || !axes_[i].position) return false;
  const long long data = velocityData(i);
  if (const auto end = endOfVelocity(i, data)) {
    ask(Kind::kVelocity, i, "move abs " + std::to_string(*end) + " " + std::to_string(std::abs(data)), data,
        static_cast<double>(*end) / config_.microsteps_per_metre[i]);
    return true;
  }
  if (axes_[i].told == data && std::isnan(axes_[i].end)) return false;
  ask(Kind::kVelocity, i, "move vel " + std::to_string(data), data);
  return true;
}

void ZaberDriver::nextInTurn() {
  const int i = turn_ / 2;
  if (turn_ % 2 == 0) {
    turn_ = turn_ + 1;
    if (nextVelocity(i)) return;
  }
  turn_ = (turn_ + 1) % 6;
  ask(Kind::kPosition, i, "get pos");
}

long long ZaberDriver::moveSpeedData(int i) const {
  const Eigen::Vector3d end = config_.joints.toDevice(goal()->joints);
  Eigen::Vector3d way;
  for (int k = 0; k < 3; ++k) way[k] = end[k] - expected(k, time());
  const double share = way.norm() > 0 ? std::abs(way[i]) / way.norm() : 1;
  return std::max(1LL, speedData(i, std::max(goal()->speed * share, kSlowest / config_.microsteps_per_metre[i])));
}

/// A move's speeds and ends, one after the other; then it is watched. A speed of the move's own is not written to the
/// device's memory, as its setting is.
bool ZaberDriver::nextOfMove() {
  if (move_done_ || !mayMove()) return false;
  for (; move_stage_ < 3; ++move_stage_) {
    const int i = move_stage_;
    const long long data = moveSpeedData(i);
    if (!*axes_[i].moves_have_speeds) return ask(Kind::kSpeed, i, "set maxspeed " + std::to_string(data), data), true;
    axes_[i].move_speed = static_cast<double>(data) / (config_.microsteps_per_metre[i] * kZaberSpeedUnit);
  }
  if (move_stage_ >= 6) {
    checkMove();
    return !talking();
  }
  const int i = move_stage_ - 3;
  const double scale = config_.microsteps_per_metre[i];
  const long long end = std::llround(config_.joints.toDevice(goal()->joints)[i] * scale);
  std::string command = "move abs " + std::to_string(end);
  if (*axes_[i].moves_have_speeds) {
    command += " " + std::to_string(std::llround(axes_[i].move_speed * scale * kZaberSpeedUnit));
  }
  ask(Kind::kMove, i, command, end);
  return true;
}

void ZaberDriver::checkMove() {
  for (const Axis& axis : axes_) {
    if (axis.busy || !axis.read_since_told || axis.filter.doubts()) return;
  }
  const Eigen::Vector3d wanted = config_.joints.toDevice(goal()->joints);
  for (int i = 0; i < 3; ++i) {
    if (std::abs(wanted[i] - *axes_[i].position) * config_.microsteps_per_metre[i] < 1.5) continue;
    if (++move_tries_ >= kMoveTries) return raiseFault(axisName(i) + " does not arrive: the move was interrupted");
    move_stage_ = 0;  // to the same place: what has been done is not done twice
    return;
  }
  move_done_ = true;
  for (Axis& axis : axes_) axis.velocity = 0;
}

}  // namespace microinjection
