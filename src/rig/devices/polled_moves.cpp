// How PolledManipulator goes to where it is wanted: move by move.

#include <algorithm>
#include <cmath>
#include <limits>

#include "rig/devices/polled_manipulator.h"

namespace microinjection {
namespace {

constexpr double kMoveAllowance = 0.5;   // s, that a move may take longer than its way at its speed, and a quarter
constexpr double kSettleTime = 0.2;      // s, in which one that says it stands may still come to rest (acq4)
constexpr double kWorthStopping = 0.15;  // s left of a move: for less, a new goal waits
constexpr int kSteady = 2;               // readings in a row of one that has arrived
constexpr int kTries = 2;                // of a move that ends elsewhere

}  // namespace

void PolledManipulator::nextOfMove() {
  if (!move_->unsaid.empty()) {
    const std::string line = move_->unsaid.front();
    move_->unsaid.erase(move_->unsaid.begin());
    if (move_->unsaid.empty()) {
      rested_.reset();
      move_->begin = time() + static_cast<double>(line.size() + 1) * common_.byteTime();
      move_->end = move_->begin + move_->duration;
      move_->overdue = listened() + 1.25 * move_->duration + kMoveAllowance;
    }
    return ask(Kind::kMove, line);
  }
  // The newest wins: a long move is broken off when it is not the one that is wanted any more.
  if (goal() && timeLeft() > kWorthStopping) {
    const bool still_wanted = !move_->follows && !goal()->follows && isThere(move_->to, goalPlace());
    const bool in_steps = move_->next > 0;
    if (!still_wanted && !in_steps) return stopFirst();
  }
  if (!dialect_.motion.empty() && !asked_motion_) return ask(Kind::kMotion, dialect_.motion);
  ask(Kind::kPosition, dialect_.position);
}

/// m/s along a way (counts), within what each axis may do.
double PolledManipulator::wantedSpeed(const Eigen::Vector3d& way) const {
  double speed = goal()->speed;
  if (goal()->follows) speed = std::max(1.2 * goal()->velocity.norm(), way.norm() * count() / common_.segment_time);
  speed = std::min(speed, common_.speed);
  const Eigen::Vector3d direction = common_.axes.inJointOrder(way.normalized()).cwiseAbs();
  for (int i = 0; i < 3; ++i) {
    if (direction[i] > 0) speed = std::min(speed, speedLimits()[i] / direction[i]);
  }
  return speed;
}

/// A whole place near `share` of a way, and nearer to the line than others that are up to half as far.
Eigen::Vector3d PolledManipulator::onTheWay(const Eigen::Vector3d& from, const Eigen::Vector3d& way, double share) {
  Eigen::Vector3d best = from;
  double least = std::numeric_limits<double>::infinity();
  for (double part = share; part > 0.5 * share; part -= 0.1 * share) {
    const Eigen::Vector3d place = (from + way * part).array().round(), gone = place - from;
    const double aside = (gone - way * (gone.dot(way) / way.squaredNorm())).norm();
    if (gone.isZero(kSame) || aside >= least) continue;
    best = place;
    least = aside;
  }
  return best;
}

void PolledManipulator::nextTowardsGoal() {
  Move move;
  move.from = *position_;
  move.to = goalPlace();
  move.follows = goal()->follows;
  const Eigen::Vector3d way = move.to - move.from;
  const double wanted = wantedSpeed(way), length = way.norm() * count();
  const bool in_steps = wanted < slowest();
  const double longest = in_steps       ? std::max(wanted * common_.segment_time, 2 * count())
                         : move.follows ? 2 * common_.segment_time * wanted
                                        : length;
  if (length > longest) move.to = onTheWay(move.from, way, longest / length);
  if (isThere(move.from, move.to)) move.to = goalPlace();
  if (move.to.cwiseAbs().maxCoeff() > 2e9) return raiseFault("the goal is too far away to be said");
  const double speed = std::max(wanted, slowest());
  const Plan said = plan(move.from, move.to, speed, common_.axes.inDeviceOrder(speedLimits()));
  move.unsaid = said.lines;
  move.duration = said.duration;
  move.next = in_steps ? time() + (move.to - move.from).norm() * count() / wanted : 0;
  move.begin = move.end = move.overdue = std::numeric_limits<double>::infinity();  // when its last line has been said
  move_ = move;
  nextOfMove();
}

/// A reading under way: the move goes on from there, has arrived, or has ended elsewhere.
void PolledManipulator::checkMove(const Eigen::Vector3d& place) {
  const bool there = isThere(place, move_->to);
  const bool told_to_stand = dialect_.motion.empty() || move_->stood;
  move_->at_goal = there && told_to_stand ? move_->at_goal + 1 : 0;
  // One that does not tell may still go the last of a count: it stands when its time is over.
  const bool stands = dialect_.motion.empty() ? move_->at_goal > 0 && time() >= move_->end
                                              : move_->at_goal >= kSteady || (move_->at_goal > 0 && timeLeft() <= 0);
  if (stands) {
    next_move_ = move_->next;
    move_.reset();
    tries_ = 0;
    return rest(place);
  }
  const bool stands_elsewhere = move_->stood && listened() > *move_->stood + kSettleTime;
  if (listened() > move_->overdue || stands_elsewhere) {
    position_ = place;
    move_.reset();
    if (++tries_ >= kTries) {
      const std::string why = whyNotArrived();
      return raiseFault("the move does not arrive: " + (why.empty() ? "it was interrupted" : why));
    }
    return stopFirst();
  }
  // The reading is as old as half its way here.
  const double then = time() - 0.5 * dialect_.longest_reading * common_.byteTime();
  const double whole = (move_->to - move_->from).norm(), left = (move_->to - place).norm();
  if (whole > 0 && then > move_->begin) {
    move_->duration *= std::min(1.0, left / whole);
    move_->from = place;
    move_->begin = then;
  }
}

}  // namespace microinjection
