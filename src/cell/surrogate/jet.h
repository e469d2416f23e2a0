#pragma once

#include <Eigen/Core>
#include <cmath>

namespace microinjection {

/// A function's value, gradient and Hessian at a point of space: forward differentiation to second
/// order.
struct Jet {
  double value = 0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();

  /// Coordinate k with this value.
  static Jet coordinate(int k, double value) {
    Jet jet;
    jet.value = value;
    jet.gradient[k] = 1;
    return jet;
  }
};

/// f(jet), given f and its first two derivatives at jet.value.
inline Jet chain(const Jet& jet, double f, double f1, double f2) {
  return {f, f1 * jet.gradient, f1 * jet.hessian + f2 * jet.gradient * jet.gradient.transpose()};
}

inline Jet operator+(const Jet& a, const Jet& b) {
  return {a.value + b.value, a.gradient + b.gradient, a.hessian + b.hessian};
}
inline Jet operator-(const Jet& a, const Jet& b) {
  return {a.value - b.value, a.gradient - b.gradient, a.hessian - b.hessian};
}
inline Jet operator*(double factor, const Jet& a) {
  return {factor * a.value, factor * a.gradient, factor * a.hessian};
}
inline Jet operator*(const Jet& a, const Jet& b) {
  const Eigen::Matrix3d mixed = a.gradient * b.gradient.transpose();
  return {a.value * b.value, a.value * b.gradient + b.value * a.gradient,
          a.value * b.hessian + b.value * a.hessian + mixed + mixed.transpose()};
}
inline Jet inverse(const Jet& a) {
  const double f = 1 / a.value;
  return chain(a, f, -f * f, 2 * f * f * f);
}
inline Jet sqrt(const Jet& a) {
  const double f = std::sqrt(a.value);
  return chain(a, f, 0.5 / f, -0.25 / (f * a.value));
}

}  // namespace microinjection
