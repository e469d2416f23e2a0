// What ZaberDriver says next: at the begin of a session, for a move, and in turn.

#include <algorithm>
#include <cmath>

#include "rigs/zaber/zaber_driver.h"

namespace microinjection {
namespace {

constexpr double kVelocityHolds = 0.1;   // s: a set-point's velocity is not followed for longer
constexpr double kLongestBraking = 1.5;  // s, after a stop
constexpr double kLongestHoming = 120;   // s
constexpr int kMoveTries = 2;
constexpr double kSlowest = 10;  // microsteps/s, of an axis of a move

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
    if (!axis.has_reference && nextOfHoming(i)) return true;
  }
  // Another axis' homing takes long.
  for (int i = 0; i < 3; ++i) {
    if (listened() - axes_[i].heard > abilities().reading_interval) return ask(Kind::kPosition, i, "get pos"), true;
  }
  settled_ = true;
  may_home_ = false;
  known();
  return false;
}

bool ZaberDriver::nextOfHoming(int i) {
  if (state() == State::kFault && !clearing()) return false;
  // Neither a cleared fault nor a device that was switched off and on is leave to move.
  if (!may_home_ || axes_[i].homed || clearing()) {
    raiseFault(axisName(i) + " has no reference position: home it, by its maker's tool or by home: true at the start");
    return true;
  }
  movesByItself();
  axes_[i].position.reset();  // its numbers begin anew
  axes_[i].read_since_begin = false;
  begun_ = listened();
  ask(Kind::kHome, i, "home");
  return true;
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

void ZaberDriver::nextInTurn() {
  const int i = turn_ / 2;
  if (turn_ % 2 == 0) {
    turn_ = turn_ + 1;
    if (goal() && goal()->follows && mayMove() && axes_[i].position) {
      const long long data = velocityData(i);
      if (axes_[i].told != data) return ask(Kind::kVelocity, i, "move vel " + std::to_string(data), data);
    }
  }
  turn_ = (turn_ + 1) % 6;
  ask(Kind::kPosition, i, "get pos");
}

/// A move's speeds and ends, one after the other; then it is watched.
bool ZaberDriver::nextOfMove() {
  if (move_done_ || !mayMove()) return false;
  if (move_stage_ >= 6) {
    checkMove();
    return !talking();
  }
  const int i = move_stage_ % 3;
  const double scale = config_.microsteps_per_metre[i];
  const Eigen::Vector3d end = config_.joints.toDevice(goal()->joints);
  if (move_stage_ >= 3) {
    const long long data = std::llround(end[i] * scale);
    ask(Kind::kMove, i, "move abs " + std::to_string(data), data);
    return true;
  }
  Eigen::Vector3d way;
  for (int k = 0; k < 3; ++k) way[k] = end[k] - expected(k, time());
  const double share = way.norm() > 0 ? std::abs(way[i]) / way.norm() : 1;
  const long long data = std::max(1LL, speedData(i, std::max(goal()->speed * share, kSlowest / scale)));
  ask(Kind::kSpeed, i, "set maxspeed " + std::to_string(data), data);
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
