#include "cell/surrogate/range_border.h"

#include <cmath>

namespace microinjection {
namespace {

constexpr double kMargin = 0.1;         ///< over the range, in which displacements saturate
constexpr double kFlattest = 0.3;       ///< depth over lateral motion of the flattest prepared paths
constexpr double kFlatMargin = 0.15;    ///< same, in which flatter ones saturate
constexpr double kAxisLateral = 0.2;    ///< lateral range on the axis, below the depth elsewhere, over that above
constexpr double kAxisNarrowing = 0.2;  ///< of the depth, over which the lateral range narrows

/// x up to 1; beyond, at most kMargin more.
Jet saturate(const Jet& x) {
  if (x.value <= 1) return x;
  const double slope = std::exp((1 - x.value) / kMargin);
  return chain(x, 1 + kMargin * (1 - slope), slope, -slope / kMargin);
}

/// Lateral range, m, as a function of the depth.
Jet lateralRange(const SurrogateRange& range, const Jet& depth) {
  Jet result;
  result.value = range.lateral;
  if (depth.value <= range.depth) return result;
  Jet below = depth;
  below.value -= range.depth;
  below = (1 / (kAxisNarrowing * range.depth)) * below;
  const Jet squared = below * below;
  const double bell = std::exp(-squared.value);
  Jet narrowing = chain(squared, bell, -bell, bell);
  narrowing = ((1 - kAxisLateral) * range.lateral) * narrowing;
  narrowing.value += kAxisLateral * range.lateral;
  return narrowing;
}

/// Ratio of depth to lateral motion, limited smoothly from kFlattest to kFlattest - kFlatMargin.
/// Flatter or rising paths were not prepared, and hardly touch the cell.
Jet steepen(const Jet& slope) {
  const double below = kFlattest - slope.value;
  if (below <= 0) return slope;
  const double factor = std::exp(-below / kFlatMargin);
  return chain(slope, kFlattest - kFlatMargin * (1 - factor), factor, factor / kFlatMargin);
}

}  // namespace

LimitedDisplacement::LimitedDisplacement(const SurrogateRange& range, bool on_axis, const Eigen::Vector3d& displacement)
    : coordinates{Jet::coordinate(0, displacement.x()), Jet::coordinate(1, displacement.y()),
                  Jet::coordinate(2, displacement.z())} {
  const double deepest = on_axis ? range.axis_depth : range.depth;
  if (-displacement.z() > deepest) {
    inside = false;
    too_deep = true;
    coordinates[2] = -deepest * saturate((-1 / deepest) * coordinates[2]);
  }
  const Jet lateral = lateralRange(range, -1.0 * coordinates[2]);
  if (displacement.head<2>().squaredNorm() > lateral.value * lateral.value) {
    inside = false;
    const Jet distance = sqrt(coordinates[0] * coordinates[0] + coordinates[1] * coordinates[1]);
    const Jet over = distance * inverse(lateral), factor = saturate(over) * inverse(over);
    coordinates[0] = coordinates[0] * factor;
    coordinates[1] = coordinates[1] * factor;
  }
  const double depth = -coordinates[2].value, across = std::hypot(coordinates[0].value, coordinates[1].value);
  if (across > 0 && depth < kFlattest * across) {
    inside = false;
    const Jet distance = sqrt(coordinates[0] * coordinates[0] + coordinates[1] * coordinates[1]);
    coordinates[2] = -1.0 * (distance * steepen(-1.0 * (coordinates[2] * inverse(distance))));
  }
}

Eigen::Vector3d LimitedDisplacement::value() const {
  return {coordinates[0].value, coordinates[1].value, coordinates[2].value};
}

Jet LimitedDisplacement::compose(const Jet& function) const {
  if (inside) return function;
  Eigen::Matrix3d jacobian;
  Jet result;
  result.value = function.value;
  for (int k = 0; k < 3; ++k) {
    jacobian.row(k) = coordinates[k].gradient.transpose();
    result.hessian += function.gradient[k] * coordinates[k].hessian;
  }
  result.gradient = jacobian.transpose() * function.gradient;
  result.hessian += jacobian.transpose() * function.hessian * jacobian;
  return result;
}

}  // namespace microinjection
