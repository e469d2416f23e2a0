#include "cell/pose/cell_hold.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace microinjection {
namespace {

constexpr double kRegained = 0.9;      // of the limit, below which a load may be for the cell to be held again
constexpr double kFaded = 1e-13;       // N
constexpr double kStiffnessSpan = 30;  // of the needle's contact, about Hertz's

/// The dish's frame has z up, which is the world's y.
const Eigen::Quaterniond& dishFromWorld() {
  static const Eigen::Quaterniond rotation(Eigen::AngleAxisd(M_PI_2, Eigen::Vector3d::UnitX()));
  return rotation;
}

/// The mouth's frame has z into the pipette, which is below.
Eigen::Vector3d mouthFromWorld(const Eigen::Vector3d& v) { return {v.x(), -v.y(), -v.z()}; }

CellMotionConfig aboutOrigin(CellMotionConfig config) {
  config.dish_height -= config.radius;
  return config;
}

}  // namespace

CellHold::CellHold(const CellMotionConfig& config, const PipetteMouth& mouth, const RoundedTip& tip)
    : radius_(config.radius),
      tip_(tip),
      motion_(aboutOrigin(config), mouth, tip),
      mouth_height_(-mouth.touchDistance(config.radius)) {}

CellMotionInput CellHold::inDish(const Input& input) const {
  const Eigen::Quaterniond& turn = dishFromWorld();
  CellMotionInput motion;
  motion.mouth = {turn * (Eigen::Vector3d(0, 0, mouth_height_) + input.mouth),
                  turn * Eigen::Quaterniond(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()))};
  motion.pressure = input.pressure;
  if (input.needle && !input.needle->inside) {
    const Eigen::Quaterniond along = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), input.needle->axis);
    motion.needle = ToolPose{turn * input.needle->tip, turn * along};
  }
  return motion;
}

Eigen::Vector3d CellHold::centreInDish() const { return dishFromWorld() * state_.offset; }

/// N, that the suction bears of the model's force, in its direction.
double CellHold::limit(const Input& input, const HoldLimits& limits) const {
  if (!input.needle || of_model_.isZero(0)) return std::numeric_limits<double>::infinity();
  // From the centre of a cell that nothing loads, which is on the mouth's axis: the limits know how far it yields.
  Eigen::Vector3d point = mouthFromWorld(input.needle->tip);
  point.z() -= mouthFromWorld(state_.offset).z();
  if (point.norm() > radius_) point *= radius_ / point.norm();
  return limits.largest(point, mouthFromWorld(-of_model_));
}

void CellHold::enter(Regime regime) {
  if (regime == regime_) return;
  regime_ = regime;
  changed_ = true;
}

const CellHold::State& CellHold::step(double duration, const Input& input) {
  const bool finite = input.mouth.allFinite() && std::isfinite(input.pressure) &&
                      (!input.needle || (input.needle->tip.allFinite() && input.needle->axis.allFinite()));
  duration_ = duration;
  if (!finite) return state_;
  if (!input.needle) {
    of_model_.setZero();
    on_needle_.setZero();
    fading_.setZero();
    changed_ = false;
  }
  const HoldLimits limits = motion_.limits(input.pressure);
  // A breath of suction that does not bear the cell's weight holds nothing.
  const bool holds = input.pressure < 0 && limits.pull() > std::abs(motion_.config().weight());
  if (!placed_) {
    placed_ = motion_.place(Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity(), inDish(input));
    copyMotion();
    if (holds) regime_ = Regime::kHeld;
    last_ = input;
  }
  state_.load = of_model_.norm();
  state_.limit = holds ? limit(input, limits) : 0;
  const bool inside = input.needle && input.needle->inside;
  if (regime_ == Regime::kHeld && (!holds || state_.load > state_.limit)) {
    motion_.place(centreInDish(), motion_.state().orientation, inDish(last_));
    enter(Regime::kMoving);
  }
  if (regime_ == Regime::kHeld) {
    state_.offset += input.mouth - last_.mouth;
    state_.mode = CellMode::kHeld;
    state_.sealed = true;
    state_.leak = 0;
    state_.seal_resistance = std::numeric_limits<double>::infinity();
  } else if (inside) {
    carry(input);
  } else {
    move(duration, input, holds);
  }
  last_ = input;
  return state_;
}

void CellHold::copyMotion() {
  const CellMotionState& motion = motion_.state();
  state_.offset = dishFromWorld().conjugate() * motion.position;
  state_.orientation = dishFromWorld().conjugate() * motion.orientation * dishFromWorld();
  state_.mode = motion.mode;
  state_.sealed = motion.sealed;
  state_.leak = motion.leak;
  state_.seal_resistance = motion.seal_resistance;
}

void CellHold::move(double duration, const Input& input, bool holds) {
  if (regime_ == Regime::kCarried) motion_.place(centreInDish(), motion_.state().orientation, inDish(last_));
  enter(Regime::kMoving);
  // Hertz's law with the stiffness that the model has there.
  const double hertz = motion_.hertzNeedleStiffness();
  double stiffness = hertz;
  if (last_.needle && !last_.needle->inside) {
    const ToolPose needle = *inDish(last_).needle;
    const Gap gap = tip_.gap(needle.toOwn(centreInDish()));
    const Eigen::Vector3d normal = dishFromWorld().conjugate() * (needle.orientation * gap.normal);
    const double overlap = radius_ - gap.distance, push = -of_model_.dot(normal);
    if (overlap > 0 && push > 0) stiffness = push / (overlap * std::sqrt(overlap));
  }
  motion_.setNeedleStiffness(std::clamp(stiffness, hertz / kStiffnessSpan, hertz * kStiffnessSpan));
  motion_.step(duration, inDish(input));
  copyMotion();
  if (!holds) {
    if (state_.mode == CellMode::kHeld || state_.mode == CellMode::kSlipping) state_.mode = CellMode::kFree;
  } else if (state_.mode == CellMode::kHeld && state_.sealed && state_.load <= kRegained * state_.limit) {
    enter(Regime::kHeld);
  }
}

void CellHold::carry(const Input& input) {
  enter(Regime::kCarried);
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  if (last_.needle) shift = input.needle->tip - last_.needle->tip;
  motion_.place(centreInDish() + dishFromWorld() * shift, motion_.state().orientation, inDish(input));
  copyMotion();
  if (state_.mode == CellMode::kHeld && state_.sealed) {
    enter(Regime::kHeld);
  } else {
    state_.mode = CellMode::kCarried;
  }
}

Eigen::Vector3d CellHold::forceOnNeedle(const Eigen::Vector3d& of_model) {
  if (!of_model.allFinite()) return of_model;
  of_model_ = of_model;
  Eigen::Vector3d force = of_model;
  if (regime_ == Regime::kMoving) force = dishFromWorld().conjugate() * -motion_.state().needle.force;
  if (regime_ == Regime::kCarried) force.setZero();
  if (std::exchange(changed_, false)) fading_ = on_needle_ - force;
  fading_ *= std::exp(-duration_ / kFade);
  if (fading_.norm() < kFaded) fading_.setZero();
  on_needle_ = force + fading_;
  return on_needle_;
}

}  // namespace microinjection
