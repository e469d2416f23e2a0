#include "cell/pose/wall_resistance.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kNearest = 1e-3, kFarthest = 100;  // gaps of the table
constexpr int kPerDecade = 40, kRows = 5 * kPerDecade + 1;

double coth(double x) { return 1 / std::tanh(x); }

/// Coefficients of a flow about a sphere beside a plane, in bispherical coordinates: the plane is at 0, the sphere at
/// alpha, cosh(alpha) = 1 + gap. What the two flows differ in are the right-hand sides of three of the equations.
class BisphericalFlow {
 public:
  enum class Motion { kTranslation, kRotation };

  BisphericalFlow(double gap, Motion motion)
      : alpha_(std::acosh(1 + gap)), motion_(motion), terms_(static_cast<int>(40 / alpha_) + 40) {
    solve();
  }

  /// On the sphere, over 6 pi mu R u or 6 pi mu R^2 w.
  double force() const {
    double sum = 0;
    for (int n = 0; n < terms_; ++n) sum += e(n) + n * (n + 1.0) * c(n);
    const double scale = std::sqrt(2.0) / 6 * std::sinh(alpha_);
    return motion_ == Motion::kTranslation ? scale * sum : -scale * std::sinh(alpha_) * sum;
  }

  /// On the turning sphere, over 8 pi mu R^3 w.
  double torque() const {
    double sum = 0;
    for (int n = 0; n < terms_; ++n) {
      const double decay = std::exp(-(2 * n + 1) * alpha_), slope = 2 * n + 1 - coth(alpha_), twice = n * (n + 1.0);
      sum += (2 + decay) * (twice * (2 * a(n) + c(n) * coth(alpha_)) - slope * e(n));
      sum += (2 - decay) * (twice * b(n) * coth(alpha_) - slope * d(n));
    }
    return (1 - std::pow(std::sinh(alpha_), 3) * sum / (4 * std::sqrt(2.0))) / 3;
  }

 private:
  double k(int n) const { return (n + 0.5) * coth((n + 0.5) * alpha_) - coth(alpha_); }
  double lambda(int n) const {
    return (std::exp(-(n + 1.5) * alpha_) / (2 * n + 3) - std::exp(-(n - 0.5) * alpha_) / (2 * n - 1)) / std::sqrt(2.0);
  }
  double a(int n) const { return n >= 1 && n <= terms_ ? a_[n] : 0; }
  double b(int n) const { return n < 1 ? 0 : (n - 1) * a(n - 1) - (2 * n + 1) * a(n) + (n + 2) * a(n + 1); }
  double c(int n) const {
    if (n < 1) return 0;
    const double homogeneous =
        -2 * k(n) * ((n - 1.0) / (2 * n - 1) * a(n - 1) - a(n) + (n + 2.0) / (2 * n + 3) * a(n + 1));
    if (motion_ == Motion::kTranslation) return homogeneous;
    return homogeneous + 4 * lambda(n) / std::sinh(alpha_) / std::sinh((n + 0.5) * alpha_);
  }
  double d(int n) const { return ((n + 1.0) * (n + 2) * a(n + 1) - (n - 1.0) * n * a(n - 1)) / 2; }
  double e(int n) const {
    const double decay = std::sqrt(2.0) * std::exp(-(n + 0.5) * alpha_), half = std::sinh((n + 0.5) * alpha_);
    const double given = motion_ == Motion::kTranslation ? 2 * decay / half
                                                         : ((2 * n + 1) * decay - lambda(n) / std::sinh(alpha_)) / half;
    return given + k(n) * ((n - 1.0) * n / (2 * n - 1) * a(n - 1) - (n + 1.0) * (n + 2) / (2 * n + 3) * a(n + 1));
  }
  double rightHandSide(int n) const {
    const double at = (n + 0.5) * alpha_, before = (n - 0.5) * alpha_, after = (n + 1.5) * alpha_;
    if (motion_ == Motion::kTranslation) return std::sqrt(2.0) * (2 * coth(at) - coth(before) - coth(after));
    const double sum =
        std::pow(2 * n + 1, 2) * (std::exp(alpha_) / (2 * n - 1) + std::exp(-alpha_) / (2 * n + 3)) / std::sinh(at) -
        (2 * n - 1) / std::sinh(before) - (2 * n + 3) / std::sinh(after);
    return -std::sqrt(2.0) * std::exp(-at) / (2 * n + 1) / std::sinh(alpha_) * sum;
  }

  /// The recurrence for a_n as a tridiagonal system; a_0 and those beyond the last are zero.
  void solve() {
    a_.assign(terms_ + 1, 0);
    std::vector<double> upper(terms_ + 1, 0);
    for (int n = 1; n <= terms_; ++n) {
      const double low = (2 * n - 1) * k(n - 1) - (2 * n - 3) * k(n),
                   high = (2 * n + 5) * k(n) - (2 * n + 3) * k(n + 1);
      const double before = low * (n - 1) / (2 * n - 1), at = -(low * n + high * (n + 1)) / (2 * n + 1);
      const double pivot = at - before * upper[n - 1];
      upper[n] = high * (n + 2) / (2 * n + 3) / pivot;
      a_[n] = (rightHandSide(n) - before * a_[n - 1]) / pivot;
    }
    for (int n = terms_ - 1; n >= 1; --n) a_[n] -= upper[n] * a_[n + 1];
  }

  double alpha_;
  Motion motion_;
  int terms_;
  std::vector<double> a_;
};

double brennerSeries(double gap) {
  const double alpha = std::acosh(1 + gap), s = std::sinh(alpha);
  double sum = 0;
  for (int n = 1; n < 40 / alpha + 40; ++n) {
    const double odd = 2 * n + 1, half = std::sinh((n + 0.5) * alpha);
    const double over =
        (2 * std::sinh(odd * alpha) + odd * std::sinh(2 * alpha)) / (4 * half * half - odd * odd * s * s);
    const double term = n * (n + 1.0) / ((2 * n - 1.0) * (2 * n + 3)) * (over - 1);
    sum += term;
    if (odd * alpha > 36) break;  // the bracket is zero in double precision, and its hyperbolic sines overflow later
  }
  return 4 * s / 3 * sum;
}

double jefferySeries(double gap) {
  const double alpha = std::acosh(1 + gap);
  double sum = 0;
  for (int n = 1; n * alpha < 40; ++n) sum += std::pow(std::sinh(alpha) / std::sinh(n * alpha), 3);
  return sum;
}

}  // namespace

WallFactors wallSeries(double gap) {
  const BisphericalFlow translation(gap, BisphericalFlow::Motion::kTranslation);
  const BisphericalFlow rotation(gap, BisphericalFlow::Motion::kRotation);
  return {brennerSeries(gap), translation.force(), rotation.force(), rotation.torque(), jefferySeries(gap)};
}

WallResistance::WallResistance() {
  rows_.reserve(kRows);
  for (int i = 0; i < kRows; ++i) {
    const double gap = kNearest * std::pow(10, static_cast<double>(i) / kPerDecade);
    const WallFactors at = wallSeries(gap);
    // Without 1 / gap, which no cubic follows.
    rows_.push_back({at.perpendicular - 1 / gap, at.parallel, at.coupling, at.rolling, at.spin});
  }
}

WallFactors WallResistance::at(double gap) const {
  if (gap >= kFarthest) {
    const double near = 1 / (1 + gap), cube = near * near * near;
    return {1 / (1 - 9.0 / 8 * near + cube / 2), 1 / (1 - 9.0 / 16 * near + cube / 8), cube * near / 8,
            1 + 5.0 / 16 * cube, 1 + cube / 8};
  }
  const double inner = std::max(gap, kNearest), x = std::log10(inner / kNearest) * kPerDecade;
  const int i = std::min(std::max(static_cast<int>(x), 1), kRows - 3);
  const double t = x - i;
  // Lagrange's cubic through four rows.
  const double weights[] = {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
                            (t + 1) * t * (t - 1) / 6};
  Row row{};
  for (int k = 0; k < 4; ++k) {
    for (std::size_t j = 0; j < row.size(); ++j) row[j] += weights[k] * rows_[i - 1 + k][j];
  }
  const double closer = std::log(inner / gap);
  return {row[0] + 1 / gap + closer / 5, row[1] + 8.0 / 15 * closer, row[2] + 2.0 / 15 * closer,
          row[3] + 2.0 / 5 * closer, row[4]};
}

}  // namespace microinjection
