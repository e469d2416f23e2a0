// PolledManipulator: moves to the goal, move by move.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "rig/devices/polled_manipulator.h"

namespace microinjection {
namespace {

constexpr double kSettleTime = 0.2;  // s, in which a device that reports rest may still come to rest (acq4)
constexpr int kSteady = 2;           // successive readings at the goal
constexpr int kShorter = 5;          // attempts to shorten a part of the path

}  // namespace

/// Sends the setting of the move, then asks for it.
void PolledManipulator::sendSetting() {
  setting_.clear();
  if (progress_.setting_sent) return request(Kind::kReadBack, settingQuery(progress_.setting));
  request(Kind::kSetting, progress_.setting);
}

void PolledManipulator::sendMove() {
  const std::string line = std::exchange(progress_.move, "");
  origin_monitor_.setMove(move_->to);
  progress_.from = move_->from;
  progress_.sent = time();
  move_->begin = time() + static_cast<double>(line.size() + 1) * common_.byteTime();
  progress_.end = move_->begin + move_->duration;
  progress_.overdue = activeTime() + 1.25 * move_->duration + kMoveAllowance;
  request(Kind::kMove, line);
  extrapolateFor(move_->begin - time() + extrapolationTime());
}

void PolledManipulator::nextOfMove() {
  if (!progress_.setting.empty()) return sendSetting();
  if (!progress_.move.empty()) return sendMove();
  if (isOutdated()) return stopFirst();
  if (!dialect_.motion.empty() && !motion_requested_) return request(Kind::kMotion, dialect_.motion);
  request(Kind::kPosition, dialect_.position);
}

/// A whole-count position near `share` of the path to the goal, and nearer to the line than others
/// down to half as far. The line starts at the first part's start, so that rounding errors do not
/// add up.
Eigen::Vector3d PolledManipulator::pointOnPath(const Eigen::Vector3d& from, double share) const {
  const Eigen::Vector3d line = (line_->goal - line_->begin).normalized();
  const Eigen::Vector3d start = line_->begin + line * line.dot(from - line_->begin), displacement = line_->goal - start;
  Eigen::Vector3d best = from;
  double least = std::numeric_limits<double>::infinity();
  for (double part = share; part > 0.5 * share; part -= 0.1 * share) {
    const Eigen::Vector3d position = (start + displacement * part).array().round(), travelled = position - start;
    const double deviation = (travelled - line * travelled.dot(line)).norm();
    if ((position - from).isZero(kSame) || deviation >= least) continue;
    best = position;
    least = deviation;
  }
  return best;
}

/// Moves to the goal, or as far as the device stays on the line and within the wanted speed. Slower
/// paths are travelled in steps with pauses. Where the speed of an axis is rounded, a new part
/// starts before the line is left.
void PolledManipulator::nextTowardsGoal() {
  const Eigen::Vector3d from = *position_, goal_position = goalPosition(), displacement = goal_position - from;
  if (goal_position.cwiseAbs().maxCoeff() > 2e9) return raiseFault("the goal exceeds the range of the protocol");
  const Eigen::Vector3d fastest = common_.axes.inDeviceOrder(speedLimits());
  const double wanted = std::min(requestedSpeed(displacement), fastestAlong(displacement));
  Plan chosen = plan(from, goal_position, wanted, fastest);
  if (!line_ || goal()->follows || line_->goal != goal_position || !isAt(from, line_->next)) {
    line_ = Line{from, goal_position, from};
  }
  const bool in_steps = chosen.speed > 1.01 * wanted;
  double part = 1 / std::max(1.0, chosen.deviation);
  if (in_steps) part = std::min(part, std::max(wanted * common_.segment_time, 2 * count()) / length(displacement));
  if (goal()->follows) part = std::min(part, 2 * common_.segment_time * wanted / length(displacement));
  Eigen::Vector3d to = goal_position;
  for (int i = 0; i < kShorter && part < 1; ++i) {
    to = pointOnPath(from, part);
    if (isAt(from, to)) to = goal_position;
    chosen = plan(from, to, wanted, fastest);
    if (chosen.deviation <= 1) break;
    part /= chosen.deviation;
  }
  line_->next = to;
  line_margin_ = std::min(reading_margin_, kStraight + 2 * count() + kExtrapolatedMotion * chosen.speed);
  const double not_sent = std::numeric_limits<double>::infinity();
  move_ = Move{from, to, goal_position, goal()->follows, not_sent, chosen.duration};
  progress_ = Progress{};
  progress_.setting = chosen.setting == setting_ ? "" : chosen.setting;
  progress_.move = chosen.move;
  progress_.speed = chosen.speed;
  if (in_steps) progress_.next = time() + length(to - from) / wanted;
  nextOfMove();
}

/// Handles a reading during a move: it continues, has arrived, or has missed its goal.
void PolledManipulator::checkMove(const Eigen::Vector3d& position) {
  const bool there = isAt(position, move_->to);
  const bool reports_rest = dialect_.motion.empty() || progress_.at_rest_since;
  progress_.at_goal = there && reports_rest ? progress_.at_goal + 1 : 0;
  // A device that does not report rest may still move the last count, so its move ends after its
  // duration.
  const bool at_rest = dialect_.motion.empty()
                           ? progress_.at_goal > 0 && time() >= progress_.end
                           : progress_.at_goal >= kSteady || (progress_.at_goal > 0 && timeLeft() <= 0);
  if (at_rest && position.isZero(kSame) && !progress_.zero_checked && !confirmed_.empty()) {
    lost_setting_replies_ = 0;
    // A device that was switched off just before its goal also reads 0 at rest there.
    progress_.zero_checked = check_setting_ = true;
    return;
  }
  if (at_rest) {
    next_move_ = progress_.next;
    tries_ = overdue_ = too_fast_ = 0;
    return rest(position);
  }
  const bool rests_elsewhere = progress_.at_rest_since && activeTime() > *progress_.at_rest_since + kSettleTime;
  if (activeTime() > progress_.overdue || rests_elsewhere) return handleMissedGoal(position);
  // The reading was taken half its transmission time ago.
  const double then = time() - 0.5 * dialect_.longest_reading * common_.byteTime();
  const double whole = (move_->to - move_->from).norm(), left = (move_->to - position).norm();
  if (whole > 0 && then > move_->begin) {
    move_->duration *= std::min(1.0, left / whole);
    move_->from = position;
    move_->begin = then;
  }
}

/// Whether a reading on the way is further along it than the device can have come since the move was sent. The time of
/// receipt is an upper bound of that of the reading, and the whole move is compared: a program that stood still reads
/// late, but never too far. A reading beside the way is judged elsewhere.
bool PolledManipulator::isTooFar(const Eigen::Vector3d& position) const {
  if (!isUnderWay() || besideTheLine(position) > line_margin_) return false;
  const Eigen::Vector3d way = (move_->to - progress_.from).normalized();
  const double along = (position - progress_.from).dot(way) * count();
  const double margin = std::min(reading_margin_, kStraight + 2 * count());
  return along > kFaster * progress_.speed * (time() - progress_.sent) + margin;
}

/// Stops a move that is too fast. Where the device is by now is not known before it rests.
void PolledManipulator::handleTooFast() {
  if (++too_fast_ >= kTries) {
    too_fast_ = 0;
    return raiseFault(
        "it moves faster than it was told, or its replies are changed on the line; check cable and port, then enable");
  }
  forgetPosition();
  stopUnheard();
}

/// Handles a move that ended before its goal. A device is hardly ever stopped exactly at 0. A
/// device that was switched off there, or close enough to seem on its path, reads 0.
void PolledManipulator::handleMissedGoal(const Eigen::Vector3d& position) {
  if (detectNewOrigin(position, 0, position.isZero(kSame) && !origin_monitor_.mayStandAt(position, counts(), 0), 0))
    return;
  position_ = position;
  move_.reset();
  if (++tries_ < kTries) return stopFirst();
  const std::string reason = notArrivedReason();
  raiseFault(kNotArrived + (reason.empty() ? "it was interrupted" : reason));
}

}  // namespace microinjection
