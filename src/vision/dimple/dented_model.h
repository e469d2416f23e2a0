#pragma once

#include <ceres/jet.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "vision/dimple/dented_ellipse.h"

namespace microinjection::dented {

/// The parameters of a DentedEllipse's fit, in radii: centre (across, along the needle), the square root
/// of the ellipse's matrix (2, 3, 4), then depth, logarithm of the width, and tail of the dent.
constexpr int kShape = 5, kDent = 3;

/// The needle's frame about the start's centre, in units of its radius: across, along.
struct Local {
  Eigen::Vector2d origin, u, v;
  double unit;

  Local(const NeedleAxis& axis, const Ellipse& start)
      : origin(start.centre.x, start.centre.y),
        u(axis.along().x, axis.along().y),
        v(axis.across().x, axis.across().y),
        unit(0.5 * start.meanDiameter()) {}
  Eigen::Vector2d of(const cv::Point2d& point) const {
    const Eigen::Vector2d d = Eigen::Vector2d(point.x, point.y) - origin;
    return Eigen::Vector2d(d.dot(v), d.dot(u)) / unit;
  }
};

/// Share of the displacement at a height above the centre (in radii).
inline double fadeAt(double height) {
  const double h = std::clamp(height, 0.0, 1.0);
  return 1 - (1 - h) * (1 - h) * (1 - h);
}

/// Displacement at a distance from the axis over that on it.
template <typename T>
T bell(const T& square, const T& tail) {
  using std::exp;
  using std::log;
  return exp(-log(T(1) + tail * square) / (T(2) * tail));
}

/// Distance of a border's point from the model, in radii.
struct Cost {
  double across, along, side, fade, weight;  ///< side: distance from the axis
  bool facing;

  template <typename T>
  bool operator()(const T* shape, const T* dent, T* residual) const {
    using std::exp;
    using std::sqrt;
    T z = T(along);
    if (facing) {
      const T ratio = T(side) * exp(-dent[1]);
      z += dent[0] * T(fade) * bell(T(ratio * ratio), dent[2]);
    }
    const T dx = T(across) - shape[0], dy = z - shape[1];
    const T ux = shape[2] * dx + shape[4] * dy, uy = shape[4] * dx + shape[3] * dy;
    const T length = sqrt(ux * ux + uy * uy);
    const T vx = (shape[2] * ux + shape[4] * uy) / length, vy = (shape[4] * ux + shape[3] * uy) / length;
    *residual = T(weight) * (length - T(1)) / sqrt(vx * vx + vy * vy);
    return true;
  }
};

using Vector = Eigen::Matrix<double, kShape + kDent, 1>;
using Matrix = Eigen::Matrix<double, kShape + kDent, kShape + kDent>;
using Jet = ceres::Jet<double, kShape + kDent>;
enum Index { kDepth = kShape, kLogWidth, kTail };

/// Residual with its derivatives for all parameters.
inline Jet jetOf(const Cost& cost, const Vector& p) {
  Jet variables[kShape + kDent], residual;
  for (int i = 0; i < kShape + kDent; ++i) variables[i] = Jet(p[i], i);
  cost(variables, variables + kShape, &residual);
  return residual;
}

inline double residualOf(const Cost& cost, const Vector& p) {
  double residual = 0;
  cost(p.data(), p.data() + kShape, &residual);
  return residual;
}

Vector startOf(const Ellipse& start, const Local& local);
Ellipse ellipseOf(const Vector& parameters, const Local& local);

/// Height at which the line `across` leaves the ellipse towards the shaft; below the centre's where it misses it.
double heightAt(const Vector& parameters, double across);

}  // namespace microinjection::dented
