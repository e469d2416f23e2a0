#pragma once

#include <algorithm>
#include <cmath>

namespace microinjection {

/// A robust loss of residuals, in units of its scale's square: Cauchy's, or Tukey's, which leaves out the
/// residuals above the scale.
struct RobustLoss {
  double scale;
  bool tukey;

  /// Tukey's scale over the standard deviation, for 95 % efficiency with normal residuals.
  static constexpr double kTukey = 4.685;

  double value(double residual) const {
    const double square = residual * residual / (scale * scale), rest = 1 - square;
    return tukey ? (rest > 0 ? 1 - rest * rest * rest : 1) / 6 : 0.5 * std::log1p(square);
  }
  double weight(double residual) const {
    const double square = residual * residual / (scale * scale), rest = std::max(0.0, 1 - square);
    return (tukey ? rest * rest : 1 / (1 + square)) / (scale * scale);
  }
};

}  // namespace microinjection
