#pragma once

#include <Eigen/Core>
#include <vector>

namespace microinjection {

/// Parameters of base + height exp(-(x - middle)^2 / (2 width^2)): base, height, middle, ln(width).
using Bell = Eigen::Vector4d;

/// A plane in units of a fit: its height in steps of the planes from the sharpest one, its sharpness in
/// units of the range.
struct BellPoint {
  double height, sharpness;
  bool used = true;  ///< false: an outlier
};

struct BellFit {
  static constexpr int kParameters = 4;

  Bell bell = Bell::Zero();
  double squares = 0;  ///< of the used points
  int used = 0;
  double deviation = 0;  ///< of the middle, steps
  bool good = false;
  int freedom() const { return used - kParameters; }
};

/// Fits a bell (Ceres): with Cauchy's loss first, then by least squares without the outliers, which it
/// marks. `width`: steps, to start from.
BellFit fitBell(std::vector<BellPoint>& points, double width);

/// Whether a bell describes the used points better than their mean, by an F test.
/// @param false_rate  of bells found in a series without one
bool bellIsNeeded(const std::vector<BellPoint>& points, const BellFit& result, double false_rate);

}  // namespace microinjection
