#include "cell/pose/cell_motion.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace microinjection {
namespace {

constexpr int kMotionSolutions = 8;    // of a step, each with the normal forces of the one before
constexpr int kMotionIterations = 60;  // Newton's, of a solution
constexpr int kMotionHalvings = 40;    // of Newton's step
constexpr int kLargestDivision = 64;   // of a step in which a tool jumps
constexpr double kLongestShift = 0.2;  // of a tool in a part of a step, over the cell's radius
constexpr double kLevels = 0.1;        // slope of the energy at a guess of the motion, over that at rest
constexpr double kLimitAgrees = 1e-3;  // of Coulomb's limits of two solutions

/// |slide| and its first two derivatives, rounded below h: y^2/h - y^3/(3 h^2), then y - h/3.
struct RoundedSlide {
  double value, slope, curvature;
  RoundedSlide(double y, double h) {
    const double t = y / h;
    value = t < 1 ? y * t * (1 - t / 3) : y - h / 3;
    slope = t < 1 ? t * (2 - t) : 1;
    curvature = t < 1 ? 2 * (1 - t) / h : 0;
  }
};

double hertzStiffness(double modulus, double radius) { return 4.0 / 3 * modulus * std::sqrt(radius); }

const WallResistance& sharedWallResistance() {
  static const WallResistance resistance;
  return resistance;
}

bool isPose(const ToolPose& pose) { return pose.position.allFinite() && std::abs(pose.orientation.norm() - 1) < 1e-3; }

ToolPose between(const ToolPose& from, const ToolPose& to, double share) {
  return {from.position + share * (to.position - from.position), from.orientation.slerp(share, to.orientation)};
}

/// m, how far the tool's point that is at `at` now has moved.
Eigen::Vector3d shiftAt(const ToolPose& from, const ToolPose& to, const Eigen::Vector3d& at) {
  return at - from.toDish(to.toOwn(at));
}

}  // namespace

const char* name(CellMode mode) {
  switch (mode) {
    case CellMode::kSwallowed:
      return "swallowed";
    case CellMode::kHeld:
      return "held";
    case CellMode::kSlipping:
      return "slipping";
    case CellMode::kLost:
      return "lost";
    case CellMode::kResting:
      return "resting";
    case CellMode::kFree:
      return "free";
    case CellMode::kCarried:
      return "carried";
  }
  return "";
}

CellMotion::CellMotion(const CellMotionConfig& config, const std::optional<PipetteMouth>& mouth,
                       const std::optional<RoundedTip>& tip)
    : config_(config), mouth_(mouth), tip_(tip), wall_(&sharedWallResistance()) {
  config.validate();
  const double modulus = config.contactModulus();
  dish_stiffness_ = hertzStiffness(modulus, config.radius);
  if (tip_) hertz_needle_stiffness_ = hertzStiffness(modulus, 1 / (1 / config.radius + 1 / tip_->edgeRadius()));
  needle_stiffness_ = hertz_needle_stiffness_;
  if (mouth_) {
    lip_.emplace(*mouth_, config.radius, modulus);
    suction_.emplace(*mouth_, config);
  }
}

HoldLimits CellMotion::limits(double pressure, double notch_area) const {
  if (!mouth_ || suction_->swallows()) return HoldLimits(0, 0, config_.radius, 0);
  const double closed = suction_->share(0, suction_->notchConductance(notch_area));
  const double suction = closed * std::max(-pressure, 0.0);
  if (suction <= 0) return HoldLimits(0, suction_->sealRadius(), config_.radius, config_.friction.lip);
  return HoldLimits(suction * suction_->area(), suction_->sealRadius(), config_.radius, config_.friction.lip,
                    {suction_->releasedRadius(suction), suction_->lateralStiffness(suction)});
}

const char* CellMotion::refusal(const CellMotionInput& input) const {
  if (!isPose(input.mouth)) return "the holding pipette's pose is not finite, or its quaternion not of length 1";
  if (!std::isfinite(input.pressure)) return "the pressure is not finite";
  if (!Range::nonNegative().contains(input.notch_area)) return "the notch's area is negative or not finite";
  if (input.pressure != 0 && !mouth_) return "a pressure without a holding pipette";
  if (input.needle && !tip_) return "a pose of a needle that is not there";
  if (input.needle && !isPose(*input.needle))
    return "the needle's pose is not finite, or its quaternion not of length 1";
  if (!input.force.allFinite() || !input.torque.allFinite()) return "the load is not finite";
  return nullptr;
}

bool CellMotion::place(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation,
                       const CellMotionInput& input) {
  state_.refusal = isPose({position, orientation}) ? refusal(input) : "the cell's pose is not finite";
  if (state_.refusal) return false;
  state_ = CellMotionState();
  state_.position = position;
  state_.orientation = orientation.normalized();
  swallowed_ = false;
  now_ = before_ = input;
  prepare(1);
  gather(Motion::Zero(), false);
  report(1, Motion::Zero());
  state_.energy.potential = potential(Motion::Zero()).energy;
  return true;
}

const CellMotionState& CellMotion::step(double duration, const CellMotionInput& input) {
  state_.refusal = duration > 0 && std::isfinite(duration) ? refusal(input) : "the duration is not above 0 and finite";
  if (state_.refusal) return state_;
  state_.iterations = 0;
  const double held = state_.energy.potential;
  state_.energy = CellMotionEnergy();
  state_.energy.potential = held;
  if (swallowed_) {
    carry(input);
    return state_;
  }
  const CellMotionInput from = now_;
  double shift = mouth_ ? shiftAt(from.mouth, input.mouth, state_.position).norm() : 0;
  if (input.needle && from.needle) {
    shift = std::max(shift, shiftAt(*from.needle, *input.needle, state_.position).norm());
  }
  const double parts = std::min(std::ceil(shift / (kLongestShift * config_.radius)), double{kLargestDivision});
  const int count = std::max(static_cast<int>(parts), 1);
  for (int i = 1; i <= count; ++i) {
    CellMotionInput part = input;
    if (i < count) {
      part.mouth = between(from.mouth, input.mouth, double(i) / count);
      if (input.needle && from.needle) part.needle = between(*from.needle, *input.needle, double(i) / count);
    }
    substep(duration / count, part);
  }
  return state_;
}

void CellMotion::carry(const CellMotionInput& input) {
  const Eigen::Vector3d own = now_.mouth.toOwn(state_.position);
  state_.orientation = input.mouth.orientation * now_.mouth.orientation.conjugate() * state_.orientation;
  state_.position = input.mouth.toDish(own);
  now_ = before_ = input;
}

Eigen::Vector3d CellMotion::middle() const { return now_.mouth.toDish({0, 0, mouth_->side() * suction_->middle()}); }

void CellMotion::prepare(double duration) {
  start_ = state_.position;
  const double gap = start_.z() - config_.radius - config_.dish_height;
  const WallFactors wall = wall_->at(std::max(gap, config_.roughness) / config_.radius);
  resistance_.setZero();
  resistance_.diagonal() << wall.parallel, wall.parallel, wall.perpendicular, 4.0 / 3 * wall.rolling,
      4.0 / 3 * wall.rolling, 4.0 / 3 * wall.spin;
  resistance_(0, 4) = resistance_(4, 0) = -wall.coupling;
  resistance_(1, 3) = resistance_(3, 1) = wall.coupling;
  resistance_ *= config_.drag() / duration;
  rounding_ = config_.creep_speed * duration;
  double pull = 0;
  if (mouth_) {
    notch_ = suction_->notchConductance(now_.notch_area);
    const double mean = (start_ - middle()).norm() - suction_->touch();
    const double leaking = suction_->swallows() ? 0 : lip_->leakingGap(now_.mouth.toOwn(start_));
    gap_shift_ = leaking > 0 ? leaking - mean : 0;
    const double share = suction_->share(mean + gap_shift_, notch_);
    sink_ = -now_.pressure * suction_->flow(share) * config_.drag() / (4 * M_PI);
    pull = std::abs(now_.pressure) * suction_->area();
  }
  tolerance_ = 1e-5 * std::abs(config_.weight()) + 1e-8 * pull + 1e-9 * config_.drag() * config_.radius;
}

void CellMotion::substep(double duration, const CellMotionInput& input) {
  before_ = now_;
  now_ = input;
  prepare(duration);
  Motion motion = Motion::Zero();
  const double begin = potential(motion).energy;
  state_.energy.work += begin - state_.energy.potential;
  double limit = gather(motion, true);
  for (int i = 0; i < kMotionSolutions; ++i) {
    minimise(duration, motion);
    if (i + 1 == kMotionSolutions) break;
    // The last solution must be that with these normal forces: forget those that it leads to.
    const auto frictions = frictions_;
    const int count = friction_count_;
    const double next = gather(motion, false);
    const bool agree = std::abs(next - limit) <= kLimitAgrees * std::max(next, limit);
    limit = next;
    if (!agree) continue;
    frictions_ = frictions;
    friction_count_ = count;
    break;
  }
  const double end = potential(motion).energy;
  state_.energy.potential = end;
  state_.energy.rise += end - begin;
  state_.energy.viscous += motion.dot(resistance_ * motion);
  state_.energy.friction += frictionPotential(motion) - frictionPotential(Motion::Zero());
  finish(duration, motion);
}

CellMotion::Potential CellMotion::potential(const Motion& motion) const {
  Potential sum;
  const Eigen::Vector3d at = start_ + motion.head<3>();
  sum.energy = config_.weight() * (at.z() - config_.dish_height) - now_.force.dot(motion.head<3>()) -
               now_.torque.dot(motion.tail<3>()) / config_.radius;
  sum.gradient << -now_.force, -now_.torque / config_.radius;
  sum.gradient.z() += config_.weight();
  addContacts(at, sum);
  if (mouth_) addSuction(at, sum);
  return sum;
}

CellMotion::Potential CellMotion::increment(const Motion& motion) const {
  Potential sum = potential(motion);
  const Motion drag = resistance_ * motion;
  sum.energy += motion.dot(drag) / 2;
  sum.gradient += drag;
  sum.convex += resistance_;
  addFriction(motion, sum);
  return sum;
}

void CellMotion::addContacts(const Eigen::Vector3d& at, Potential& sum) const {
  const auto hertz = [&](double stiffness, double overlap, const Eigen::Vector3d& normal,
                         const Eigen::Matrix3d& curvature) {
    if (overlap <= 0) return;
    const double root = stiffness * std::sqrt(overlap), push = root * overlap;
    sum.energy += 0.4 * push * overlap;
    sum.gradient.head<3>() -= push * normal;
    sum.convex.topLeftCorner<3, 3>() += 1.5 * root * normal * normal.transpose();
    sum.concave -= push * curvature;
  };
  hertz(dish_stiffness_, config_.radius - (at.z() - config_.dish_height), Eigen::Vector3d::UnitZ(),
        Eigen::Matrix3d::Zero());
  if (now_.needle) {
    const Eigen::Matrix3d turn = now_.needle->orientation.toRotationMatrix();
    const Gap gap = tip_->gap(now_.needle->toOwn(at));
    hertz(needle_stiffness_, config_.radius - gap.distance, turn * gap.normal, turn * gap.curvature * turn.transpose());
  }
  if (!mouth_) return;
  const LipContact::Forces lip = lip_->at(now_.mouth.toOwn(at));
  if (lip.angle <= 0) return;
  Eigen::Vector3d push = Eigen::Vector3d::Zero();
  Eigen::Matrix3d convex = Eigen::Matrix3d::Zero(), concave = Eigen::Matrix3d::Zero();
  for (const LipContact::Point& point : lip.points) {
    const Eigen::Matrix3d along = point.normal * point.normal.transpose();
    push += point.push * point.normal;
    convex += point.stiffness * along;
    concave -= point.push / point.distance * (Eigen::Matrix3d::Identity() - along);
  }
  const Eigen::Matrix3d turn = now_.mouth.orientation.toRotationMatrix();
  sum.energy += lip.energy;
  sum.gradient.head<3>() -= turn * push;
  sum.convex.topLeftCorner<3, 3>() += turn * convex * turn.transpose();
  sum.concave += turn * concave * turn.transpose();
}

void CellMotion::addSuction(const Eigen::Vector3d& at, Potential& sum) const {
  const Eigen::Vector3d from = at - middle();
  const double r = std::max(from.norm(), 1e-6 * config_.radius), pull = -now_.pressure * suction_->area();
  const Eigen::Vector3d away = from / r;
  const double gap = r - suction_->touch() + gap_shift_, step = 1e-6 * config_.radius;
  const double share = suction_->share(gap, notch_), slope = (suction_->share(gap + step, notch_) - share) / step;
  // The drag of the sink, within a sphere's radius of the middle that of its edge.
  const double far = std::max(r, config_.radius), sink = r < far ? 0 : sink_ / (far * far);
  sum.energy += pull * suction_->shareIntegral(gap, notch_) - sink_ / far;
  const double force = pull * share + sink, stiffness = pull * slope - 2 * sink / far;
  sum.gradient.head<3>() += force * away;
  const Eigen::Matrix3d along = away * away.transpose(), across = Eigen::Matrix3d::Identity() - along;
  const auto add = [&](double value, const Eigen::Matrix3d& projection) {
    if (value > 0) sum.convex.topLeftCorner<3, 3>() += value * projection;
    if (value < 0) sum.concave += value * projection;
  };
  add(force / r, across);
  add(stiffness, along);
}

double CellMotion::frictionPotential(const Motion& motion) const {
  double sum = 0;
  for (int i = 0; i < friction_count_; ++i) {
    sum += frictions_[i].limit * RoundedSlide(frictions_[i].slide(motion).norm(), rounding_).value;
  }
  return sum;
}

void CellMotion::addFriction(const Motion& motion, Potential& sum) const {
  for (int i = 0; i < friction_count_; ++i) {
    const Friction& point = frictions_[i];
    const Eigen::Vector2d u = point.slide(motion);
    const double y = std::max(u.norm(), 1e-9 * rounding_);
    const RoundedSlide rounded(y, rounding_);
    const Motion along = point.tangents.transpose() * u / y;
    const Motion across = point.tangents.transpose() * Eigen::Vector2d(-u.y(), u.x()) / y;
    const double force = point.limit * rounded.slope;
    sum.energy += point.limit * rounded.value;
    sum.gradient += force * along;
    sum.convex.noalias() += point.limit * rounded.curvature * along * along.transpose();
    sum.convex.noalias() += force / y * across * across.transpose();
  }
}

double CellMotion::gather(const Motion& motion, bool first) {
  const Eigen::Vector3d at = start_ + motion.head<3>();
  friction_count_ = 0;
  double total = 0;
  const auto add = [&](double limit, const Eigen::Vector3d& normal, const Eigen::Vector3d& shift,
                       CellContactForce CellMotionState::*contact) {
    if (limit <= 0) return;
    // The sphere's point at -R n moves by dx + rotation x (-R n) = dx + n x (R rotation); t x n = -s, s x n = t.
    const Eigen::Vector3d t = normal.unitOrthogonal(), s = normal.cross(t);
    Friction& point = frictions_[friction_count_++];
    point.tangents << t.transpose(), -s.transpose(), s.transpose(), t.transpose();
    point.shift = {t.dot(shift), s.dot(shift)};
    point.limit = limit;
    point.contact = contact;
    total += limit;
  };
  // A tool that has just moved overlaps the cell by its step: its first normal forces are those of the step before.
  const auto likeBefore = [&](double push, const CellContactForce& contact) {
    return first && contact.push > 0 && push > 0 ? std::min(contact.push / push, 1.0) : 1.0;
  };
  const auto hertz = [&](double stiffness, double overlap) {
    return overlap > 0 ? stiffness * overlap * std::sqrt(overlap) : 0.0;
  };
  const double dish = hertz(dish_stiffness_, config_.radius - (at.z() - config_.dish_height));
  add(config_.friction.dish * dish, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero(), &CellMotionState::dish);
  if (now_.needle) {
    const Gap gap = tip_->gap(now_.needle->toOwn(at));
    const double push = hertz(needle_stiffness_, config_.radius - gap.distance);
    const Eigen::Vector3d normal = now_.needle->orientation * gap.normal;
    const ToolPose& from = before_.needle ? *before_.needle : *now_.needle;
    add(config_.friction.needle * push * likeBefore(push, state_.needle), normal,
        shiftAt(from, *now_.needle, at - config_.radius * normal), &CellMotionState::needle);
  }
  if (!mouth_) return total;
  const LipContact::Forces lip = lip_->at(now_.mouth.toOwn(at));
  if (lip.angle <= 0) return total;
  double push = 0;
  for (const LipContact::Point& point : lip.points) push += point.push;
  const double share = config_.friction.lip * likeBefore(push, state_.lip);
  for (const LipContact::Point& point : lip.points) {
    const Eigen::Vector3d normal = now_.mouth.orientation * point.normal;
    add(share * point.push, normal, shiftAt(before_.mouth, now_.mouth, at - config_.radius * normal),
        &CellMotionState::lip);
  }
  return total;
}

void CellMotion::minimise(double duration, Motion& motion) {
  Potential here = increment(motion);
  const Potential still = motion.isZero(0) ? here : increment(Motion::Zero());
  if (still.energy < here.energy) {
    here = still;  // so that the energy is bounded
    motion.setZero();
  }
  // Motion with the mouth, or that of the step before, is mostly a better start. But where the energy still falls
  // steeply ahead, a barrier may lie in between: that of a seal which opens, for example.
  Motion carried = Motion::Zero(), onward;
  if (mouth_) carried.head<3>() = shiftAt(before_.mouth, now_.mouth, start_);
  onward << state_.velocity * duration, state_.angular_velocity * config_.radius * duration;
  for (const Motion& start : {carried, onward}) {
    if (start.isZero(0)) continue;
    const Potential there = increment(start);
    const bool levels = there.gradient.dot(start) >= kLevels * std::min(still.gradient.dot(start), 0.0);
    if (!levels || there.energy >= here.energy) continue;
    here = there;
    motion = start;
  }
  for (int i = 0; i < kMotionIterations && here.gradient.norm() > tolerance_; ++i, ++state_.iterations) {
    Matrix6 hessian = here.convex;
    hessian.topLeftCorner<3, 3>() += here.concave;
    Eigen::LLT<Matrix6> factor(hessian);
    if (factor.info() != Eigen::Success) factor.compute(here.convex);
    Motion step = -factor.solve(here.gradient);
    const double longest = config_.radius / 2, length = step.norm();
    if (!(length > 0)) return;
    if (length > longest) step *= longest / length;
    const double slope = here.gradient.dot(step);
    bool lower = false;
    for (int k = 0; k < kMotionHalvings && !lower; ++k, step /= 2) {
      const Motion next = motion + step;
      Potential there = increment(next);
      if (!(there.energy < here.energy + 1e-4 * std::ldexp(slope, -k))) continue;
      lower = true;
      here = there;
      motion = next;
    }
    if (!lower) return;  // as low as double precision tells
  }
}

void CellMotion::finish(double duration, const Motion& motion) {
  state_.position = start_ + motion.head<3>();
  const Eigen::Vector3d turn = motion.tail<3>() / config_.radius;
  const double angle = turn.norm();
  if (angle > 0) {
    state_.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle)) * state_.orientation;
    state_.orientation.normalize();
  }
  report(duration, motion);
}

void CellMotion::report(double duration, const Motion& motion) {
  state_.velocity = motion.head<3>() / duration;
  state_.angular_velocity = motion.tail<3>() / (config_.radius * duration);
  state_.lip = state_.dish = state_.needle = CellContactForce();
  for (const auto contact : {&CellMotionState::lip, &CellMotionState::dish, &CellMotionState::needle}) {
    CellContactForce& sum = state_.*contact;
    double limit = 0, slipping = 0;
    for (int i = 0; i < friction_count_; ++i) {
      const Friction& point = frictions_[i];
      if (point.contact != contact) continue;
      const Eigen::Vector2d u = point.slide(motion);
      const double y = std::max(u.norm(), 1e-9 * rounding_);
      const Motion force = -point.limit * RoundedSlide(y, rounding_).slope / y * (point.tangents.transpose() * u);
      sum.force += force.head<3>();
      sum.torque += config_.radius * force.tail<3>();
      sum.sliding += point.limit * y / duration;
      slipping += y >= rounding_ ? point.limit : 0;
      limit += point.limit;
    }
    sum.slips = slipping > 0.95 * limit;
    if (limit > 0) sum.sliding /= limit;
  }
  const double overlap = config_.radius + config_.dish_height - state_.position.z();
  state_.dish_gap = -overlap;
  if (overlap > 0) state_.dish.push = dish_stiffness_ * overlap * std::sqrt(overlap);
  state_.dish.force.z() += state_.dish.push;
  if (now_.needle) {
    const Gap gap = tip_->gap(now_.needle->toOwn(state_.position));
    const double indent = config_.radius - gap.distance;
    if (indent > 0) state_.needle.push = needle_stiffness_ * indent * std::sqrt(indent);
    state_.needle.force += state_.needle.push * (now_.needle->orientation * gap.normal);
  }
  state_.sealed = false;
  state_.suction = state_.leak = 0;
  if (mouth_) {
    const Eigen::Vector3d own = now_.mouth.toOwn(state_.position);
    const LipContact::Forces lip = lip_->at(own);
    state_.sealed = lip.angle >= M_PI && !suction_->swallows();
    if (lip.angle > 0) {
      for (const LipContact::Point& point : lip.points) {
        state_.lip.push += point.push;
        state_.lip.force += point.push * (now_.mouth.orientation * point.normal);
      }
    }
    const double mean = (state_.position - middle()).norm() - suction_->touch();
    const double gap = suction_->swallows() ? mean : lip_->leakingGap(own);
    const double share = suction_->share(gap, notch_);
    state_.suction = -now_.pressure * suction_->area() * share;
    state_.leak = -now_.pressure * suction_->flow(share);
    state_.seal_resistance = share < 1 ? share / suction_->flow(share) : std::numeric_limits<double>::infinity();
    const double radial = std::hypot(own.x(), own.y());
    swallowed_ = suction_->swallows() && mouth_->side() * own.z() > 0 && radial < mouth_->innerRadius();
  }
  state_.mode = mode();
}

CellMode CellMotion::mode() const {
  if (swallowed_) return CellMode::kSwallowed;
  if (mouth_ && state_.suction > 0 && state_.lip.push > 0) {
    return state_.lip.slips ? CellMode::kSlipping : CellMode::kHeld;
  }
  if (mouth_ && (state_.position - now_.mouth.position).norm() > config_.lost_distance) return CellMode::kLost;
  return state_.dish.push > 0 ? CellMode::kResting : CellMode::kFree;
}

}  // namespace microinjection
