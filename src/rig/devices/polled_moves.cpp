// How PolledManipulator goes to where it is wanted: move by move.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "rig/devices/polled_manipulator.h"

namespace microinjection {
namespace {

constexpr double kMoveAllowance = 0.5;  // s, that a move may take longer than its way at its speed, and a quarter
constexpr double kSettleTime = 0.2;     // s, in which one that says it stands may still come to rest (acq4)
constexpr int kSteady = 2;              // readings in a row of one that has arrived
constexpr int kShorter = 5;             // parts of a way that are tried
constexpr int kTries = 2;               // of a move that ends elsewhere

}  // namespace

void PolledManipulator::sayMove() {
  if (!progress_.setting.empty()) {
    setting_ = std::exchange(progress_.setting, "");  // if this fails, the session that follows forgets it
    return ask(Kind::kMove, setting_);
  }
  const std::string line = std::exchange(progress_.move, "");
  watch_.goesTo(move_->to);
  move_->begin = time() + static_cast<double>(line.size() + 1) * common_.byteTime();
  progress_.end = move_->begin + move_->duration;
  progress_.overdue = listened() + 1.25 * move_->duration + kMoveAllowance;
  ask(Kind::kMove, line);
}

void PolledManipulator::nextOfMove() {
  if (!progress_.move.empty()) return sayMove();
  if (isOutdated()) return stopFirst();
  if (!dialect_.motion.empty() && !asked_motion_) return ask(Kind::kMotion, dialect_.motion);
  ask(Kind::kPosition, dialect_.position);
}

/// A whole place near `share` of the way to the goal, and nearer to the line than others that are up to half as far.
/// The line is that from the first part's begin, so that roundings do not add up.
Eigen::Vector3d PolledManipulator::onTheWay(const Eigen::Vector3d& from, double share) const {
  const Eigen::Vector3d line = (line_->goal - line_->begin).normalized();
  const Eigen::Vector3d start = line_->begin + line * line.dot(from - line_->begin), way = line_->goal - start;
  Eigen::Vector3d best = from;
  double least = std::numeric_limits<double>::infinity();
  for (double part = share; part > 0.5 * share; part -= 0.1 * share) {
    const Eigen::Vector3d place = (start + way * part).array().round(), gone = place - start;
    const double aside = (gone - line * gone.dot(line)).norm();
    if ((place - from).isZero(kSame) || aside >= least) continue;
    best = place;
    least = aside;
  }
  return best;
}

/// The way to the goal, or as much of it as the device goes on its line and no faster than it should: slower ways are
/// gone in steps with pauses, and where an axis' speed is rounded the line is taken up again before it is lost.
void PolledManipulator::nextTowardsGoal() {
  const Eigen::Vector3d from = *position_, goal_place = goalPlace(), way = goal_place - from;
  if (goal_place.cwiseAbs().maxCoeff() > 2e9) return raiseFault("the goal is too far away to be said");
  const Eigen::Vector3d fastest = common_.axes.inDeviceOrder(speedLimits());
  const double wanted = std::min(askedSpeed(way), fastestAlong(way));
  Plan said = plan(from, goal_place, wanted, fastest);
  if (!line_ || goal()->follows || line_->goal != goal_place || !isThere(from, line_->next)) {
    line_ = Line{from, goal_place, from};
  }
  const bool in_steps = said.speed > 1.01 * wanted;
  double part = 1 / std::max(1.0, said.aside);
  if (in_steps) part = std::min(part, std::max(wanted * common_.segment_time, 2 * count()) / length(way));
  if (goal()->follows) part = std::min(part, 2 * common_.segment_time * wanted / length(way));
  Eigen::Vector3d to = goal_place;
  for (int i = 0; i < kShorter && part < 1; ++i) {
    to = onTheWay(from, part);
    if (isThere(from, to)) to = goal_place;
    said = plan(from, to, wanted, fastest);
    if (said.aside <= 1) break;
    part /= said.aside;
  }
  line_->next = to;
  const double not_said = std::numeric_limits<double>::infinity();
  move_ = Move{from, to, goal_place, goal()->follows, not_said, said.duration};
  progress_ = Progress{};
  progress_.setting = said.setting == setting_ ? "" : said.setting;
  progress_.move = said.move;
  if (in_steps) progress_.next = time() + length(to - from) / wanted;
  nextOfMove();
}

/// A reading under way: the move goes on from there, has arrived, or has ended elsewhere.
void PolledManipulator::checkMove(const Eigen::Vector3d& place) {
  const bool there = isThere(place, move_->to);
  const bool told_to_stand = dialect_.motion.empty() || progress_.stood;
  progress_.at_goal = there && told_to_stand ? progress_.at_goal + 1 : 0;
  // One that does not tell may still go the last of a count: it stands when its time is over.
  const bool stands = dialect_.motion.empty()
                          ? progress_.at_goal > 0 && time() >= progress_.end
                          : progress_.at_goal >= kSteady || (progress_.at_goal > 0 && timeLeft() <= 0);
  if (stands && place.isZero(kSame) && !progress_.zero_asked && !confirmed_.empty()) {
    not_kept_ = 0;
    progress_.zero_asked = ask_kept_ = true;  // one that was switched off just before its goal stands there, too
    return;
  }
  if (stands) {
    next_move_ = progress_.next;
    tries_ = 0;
    return rest(place);
  }
  const bool stands_elsewhere = progress_.stood && listened() > *progress_.stood + kSettleTime;
  if (listened() > progress_.overdue || stands_elsewhere) return endedElsewhere(place);
  // The reading is as old as half its way here.
  const double then = time() - 0.5 * dialect_.longest_reading * common_.byteTime();
  const double whole = (move_->to - move_->from).norm(), left = (move_->to - place).norm();
  if (whole > 0 && then > move_->begin) {
    move_->duration *= std::min(1.0, left / whole);
    move_->from = place;
    move_->begin = then;
  }
}

/// Nobody is stopped exactly at 0, but one that is switched off there, or near enough to pass for being on its way,
/// reads so.
void PolledManipulator::endedElsewhere(const Eigen::Vector3d& place) {
  if (beginsAnew(place, 0, place.isZero(kSame) && !watch_.mayStandAt(place, counts(), 0), 0)) return;
  position_ = place;
  move_.reset();
  if (++tries_ < kTries) return stopFirst();
  const std::string why = whyNotArrived();
  raiseFault("the move does not arrive: " + (why.empty() ? "it was interrupted" : why));
}

}  // namespace microinjection
