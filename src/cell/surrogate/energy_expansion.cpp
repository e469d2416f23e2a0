#include "cell/surrogate/energy_expansion.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace microinjection {
namespace {

constexpr int kMost = 16;              ///< largest number of terms of a polynomial in one variable
constexpr double kLargestRoot = 1.05;  ///< s of the longest displacement, with a margin
constexpr double kNothing = 1e-9;      ///< t below which the displacement is zero
constexpr int kFitPoints = 24;         ///< of s, where a product is approximated
constexpr double kSmallRoot = 0.08;    ///< s below which an approximation need not become more exact
constexpr double kBeyond = 0.1;        ///< weight of an approximation beyond the longest displacement

using Series = std::array<double, kMost>;

/// Values and first two derivatives of functions of one variable.
struct Values {
  Series f{}, f1{}, f2{};
};

void powers(double x, int degree, Values& values) {
  values.f[0] = 1;
  values.f1[0] = values.f2[0] = 0;
  for (int n = 1; n <= degree; ++n) {
    values.f[n] = x * values.f[n - 1];
    values.f1[n] = n * values.f[n - 1];
    values.f2[n] = n * values.f1[n - 1];
  }
}

void chebyshev(double s, int degree, Values& values) {
  const double slope = 2 / kLargestRoot, x = slope * s - 1;
  values.f[0] = 1;
  values.f[1] = x;
  values.f1[0] = values.f2[0] = values.f2[1] = 0;
  values.f1[1] = slope;
  for (int n = 2; n <= degree; ++n) {
    values.f[n] = 2 * x * values.f[n - 1] - values.f[n - 2];
    values.f1[n] = 2 * (slope * values.f[n - 1] + x * values.f1[n - 1]) - values.f1[n - 2];
    values.f2[n] = 2 * (2 * slope * values.f1[n - 1] + x * values.f2[n - 1]) - values.f2[n - 2];
  }
}

/// The variables of the expansion, as functions of the displacement.
struct Variables {
  Jet a, w, s;
  Jet factor;  ///< energy t^2
};

bool variables(const EnergyScales& scales, int root, const Eigen::Vector3d& u, Variables& result) {
  const double unit = 1 / scales.length;
  const Jet x = unit * Jet::coordinate(0, u.x()), y = unit * Jet::coordinate(1, u.y());
  const Jet z = unit * Jet::coordinate(2, u.z());
  const Jet squared = x * x + y * y + z * z;
  if (!(squared.value > kNothing * kNothing)) return false;
  const Jet t = sqrt(squared);
  const Jet scale = inverse(t);
  result.a = x * scale;
  result.w = z * scale;
  result.w.value += 1;
  result.s = sqrt(t);
  result.factor = scales.energy * (root == 2 ? squared : t);
  return true;
}

/// Derivatives of a function of (a, w, s).
struct Sum {
  double value = 0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();  ///< upper triangle
};

void add(Sum& sum, const Values& a, int j, const Values& w, int k, double q, double q1, double q2) {
  const double af = a.f[j], a1 = a.f1[j], wf = w.f[k], w1 = w.f1[k];
  sum.value += af * wf * q;
  sum.gradient += Eigen::Vector3d(a1 * wf * q, af * w1 * q, af * wf * q1);
  sum.hessian(0, 0) += a.f2[j] * wf * q;
  sum.hessian(0, 1) += a1 * w1 * q;
  sum.hessian(0, 2) += a1 * wf * q1;
  sum.hessian(1, 1) += af * w.f2[k] * q;
  sum.hessian(1, 2) += af * w1 * q1;
  sum.hessian(2, 2) += af * wf * q2;
}

Jet compose(const Sum& sum, const Variables& at) {
  Eigen::Matrix3d jacobian;  // rows: a, w, s
  jacobian << at.a.gradient.transpose(), at.w.gradient.transpose(), at.s.gradient.transpose();
  const Eigen::Matrix3d inner = sum.hessian.selfadjointView<Eigen::Upper>();
  Jet polynomial;
  polynomial.value = sum.value;
  polynomial.gradient = jacobian.transpose() * sum.gradient;
  polynomial.hessian = jacobian.transpose() * inner * jacobian + sum.gradient[0] * at.a.hessian +
                       sum.gradient[1] * at.w.hessian + sum.gradient[2] * at.s.hessian;
  return at.factor * polynomial;
}

/// Row of the force along a straight path over t, at s, for a unit of each T_n: T_n itself for an expansion of a force,
/// and (t^2 T_n)' / t = 2 T_n + s T_n' / 2 for one of an energy.
Eigen::RowVectorXd alongPath(int root, double s, int degree) {
  Values values;
  chebyshev(s, degree, values);
  Eigen::RowVectorXd row(degree + 1);
  for (int n = 0; n <= degree; ++n) row[n] = root == 2 ? 2 * values.f[n] + 0.5 * s * values.f1[n] : values.f[n];
  return row;
}

}  // namespace

EnergyExpansion::EnergyExpansion(const EnergyScales& scales, const EnergyDegrees& degrees)
    : scales_(scales), degrees_(degrees) {
  if (degrees.angle >= kMost || degrees.direction >= kMost || degrees.distance < 1 || degrees.distance >= kMost ||
      degrees.root < 1 || degrees.root > 2) {
    throw std::invalid_argument("EnergyExpansion: degrees must be in [1, 15], root 1 or 2");
  }
  for (int j = 0; j <= std::min(degrees.angle, degrees.direction); ++j) {
    for (int k = 0; j + k <= degrees.direction; ++k) {
      for (int i = 0; 2 * i + j <= degrees.angle; ++i) terms_.push_back({i, j, k, static_cast<int>(powers_.size())});
      powers_.emplace_back(j, k);
    }
  }
  coefficients_.setZero(size());
}

void EnergyExpansion::setCoefficients(Eigen::VectorXd coefficients) {
  if (coefficients.size() != size()) throw std::invalid_argument("EnergyExpansion: wrong number of coefficients");
  coefficients_ = std::move(coefficients);
}

void EnergyExpansion::basis(double angle, const Eigen::Vector3d& displacement, Eigen::VectorXd& energy,
                            Eigen::Matrix3Xd& gradient) const {
  energy.setZero(size());
  gradient.setZero(3, size());
  Variables at;
  if (!variables(scales_, degrees_.root, displacement, at)) return;
  Values c, a, w, s;
  powers(angle / scales_.angle, degrees_.angle, c);
  powers(at.a.value, degrees_.direction, a);
  powers(at.w.value, degrees_.direction, w);
  chebyshev(at.s.value, degrees_.distance, s);
  int index = 0;
  for (const Term& term : terms_) {
    const double angle_factor = c.f[2 * term.i + term.j];
    for (int n = 0; n <= degrees_.distance; ++n, ++index) {
      Sum sum;
      add(sum, a, term.j, w, term.k, angle_factor * s.f[n], angle_factor * s.f1[n], angle_factor * s.f2[n]);
      const Jet jet = compose(sum, at);
      energy[index] = jet.value;
      gradient.col(index) = jet.gradient;
    }
  }
}

void EnergyExpansion::makeLocal(double angle, Local& local) const {
  Values c;
  powers(angle / scales_.angle, degrees_.angle, c);
  local.scales_ = scales_;
  local.powers_ = powers_;
  local.highest_ = degrees_.direction;
  local.root_ = degrees_.root;
  local.coefficients_.setZero(degrees_.distance + 1, powers_.size());
  int index = 0;
  for (const Term& term : terms_) {
    const double angle_factor = c.f[2 * term.i + term.j];
    for (int n = 0; n <= degrees_.distance; ++n, ++index) {
      local.coefficients_(n, term.column) += angle_factor * coefficients_[index];
    }
  }
}

void EnergyExpansion::scaleAlongPaths(const std::function<double(double)>& factor,
                                      const std::function<double(double)>& size) {
  const int count = degrees_.distance + 1;
  Eigen::MatrixXd basis(kFitPoints, count), product(kFitPoints, count);
  for (int i = 0; i < kFitPoints; ++i) {
    const double s = 0.5 * kLargestRoot * (1 - std::cos(M_PI * (i + 0.5) / kFitPoints));
    // The terms are forces over t, or s^2. Near the touch and beyond the range little counts.
    const double weight = (s > 1 ? kBeyond : 1) * s * s / std::max(size(s), size(kSmallRoot));
    basis.row(i) = weight * alongPath(degrees_.root, s, degrees_.distance);
    product.row(i) = factor(s) * basis.row(i);
  }
  const Eigen::MatrixXd scaling = basis.colPivHouseholderQr().solve(product);
  Eigen::Map<Eigen::MatrixXd> series(coefficients_.data(), count, coefficients_.size() / count);
  series = (scaling * series).eval();
}

Jet EnergyExpansion::Local::evaluate(const Eigen::Vector3d& displacement) const {
  Variables at;
  if (coefficients_.cols() == 0 || !variables(scales_, root_, displacement, at)) return {};
  const int degree = static_cast<int>(coefficients_.rows()) - 1;
  Values a, w, s;
  powers(at.a.value, highest_, a);
  powers(at.w.value, highest_, w);
  chebyshev(at.s.value, degree, s);
  Sum sum;
  for (std::size_t column = 0; column < powers_.size(); ++column) {
    double q = 0, q1 = 0, q2 = 0;
    for (int n = 0; n <= degree; ++n) {
      const double coefficient = coefficients_(n, column);
      q += coefficient * s.f[n];
      q1 += coefficient * s.f1[n];
      q2 += coefficient * s.f2[n];
    }
    add(sum, a, powers_[column].first, w, powers_[column].second, q, q1, q2);
  }
  return compose(sum, at);
}

}  // namespace microinjection
