#include "cell/penetration/hole_expansion.h"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace microinjection {
namespace {

constexpr double kElementsPerFactor = 30;  ///< along a factor of e in radius
constexpr int kIterations = 60;
constexpr double kDone = 1e-11;  ///< Newton's decrement over the energy
const std::array<double, 2> kPlaces = {0.5 - 0.5 / std::sqrt(3), 0.5 + 0.5 / std::sqrt(3)};  ///< Gauss, weights 1/2

/// Matrix of a symmetric tridiagonal system, solved without exchange of rows: the energy is convex near its minimum.
struct Tridiagonal {
  Eigen::VectorXd diagonal, beside;

  explicit Tridiagonal(Eigen::Index size) : diagonal(size), beside(size) {
    diagonal.setZero();
    beside.setZero();
  }

  Eigen::VectorXd solve(Eigen::VectorXd right) const {
    Eigen::VectorXd pivot = diagonal;
    for (Eigen::Index i = 1; i < right.size(); ++i) {
      const double factor = beside[i - 1] / pivot[i - 1];
      pivot[i] -= factor * beside[i - 1];
      right[i] -= factor * right[i - 1];
    }
    for (Eigen::Index i = right.size() - 1; i >= 0; --i) {
      if (i + 1 < right.size()) right[i] -= beside[i] * right[i + 1];
      right[i] /= pivot[i];
    }
    return right;
  }
};

/// Deformation at a circle, and its derivatives with respect to q and to the slope t = dq / d ln rho.
struct Stretches {
  double square;        // rho^2
  double hoop, radial;  // r / rho, J rho / r
  double hoop_q, hoop_qq;
  double radial_q, radial_t, radial_qq, radial_qt;

  Stretches(double rho, double q, double slope) : square(rho * rho) {
    hoop = std::sqrt(1 + q / square);
    const double volume = 1 + slope / (2 * square);
    radial = volume / hoop;
    hoop_q = 1 / (2 * square * hoop);
    hoop_qq = -hoop_q * hoop_q / hoop;
    radial_t = 1 / (2 * square * hoop);
    radial_q = -volume * hoop_q / (hoop * hoop);
    radial_qt = -hoop_q / (2 * square * hoop * hoop);
    radial_qq = volume * (2 * hoop_q * hoop_q / hoop - hoop_qq) / (hoop * hoop);
  }

  Eigen::Matrix3d gradient() const { return Eigen::Vector3d(radial, hoop, 1).asDiagonal(); }
};

}  // namespace

HoleExpansion::HoleExpansion(const Material& material, double outer) : material_(material), outer_(outer) {}

/// `places`: ln rho at the nodes.
double HoleExpansion::energyOf(const Eigen::VectorXd& q, const std::vector<double>& places) const {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const double width = places[i + 1] - places[i], slope = (q[i + 1] - q[i]) / width;
    for (const double at : kPlaces) {
      const double value = (1 - at) * q[i] + at * q[i + 1];
      const double rho = std::exp(places[i] + at * width);
      if (!(1 + value / (rho * rho) > 0)) return std::numeric_limits<double>::infinity();
      const Stretches stretches(rho, value, slope);
      sum += 0.5 * width * 2 * M_PI * stretches.square * material_.energyDensity(stretches.gradient());
    }
  }
  return sum;
}

HoleExpansion::State HoleExpansion::at(double radius) const {
  const double span = std::log(outer_ / radius);
  const int elements = static_cast<int>(std::ceil(kElementsPerFactor * span));
  std::vector<double> places(elements + 1);
  for (int i = 0; i <= elements; ++i) places[i] = std::log(radius) + span * i / elements;
  Eigen::VectorXd q = Eigen::VectorXd::Constant(elements + 1, 1 - radius * radius);
  State state;
  state.energy = energyOf(q, places);
  if (!std::isfinite(state.energy)) return state;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::VectorXd residual = Eigen::VectorXd::Zero(elements + 1);
    Tridiagonal matrix(elements + 1);
    for (int i = 0; i < elements; ++i) {
      const double width = places[i + 1] - places[i], slope = (q[i + 1] - q[i]) / width;
      for (const double at : kPlaces) {
        const Stretches s(std::exp(places[i] + at * width), (1 - at) * q[i] + at * q[i + 1], slope);
        const Eigen::Matrix3d F = s.gradient(), P = material_.stress(F);
        const Material::Matrix9d C = material_.tangent(F);
        const double weight = 0.5 * width * 2 * M_PI * s.square;
        const double of_q = P(0, 0) * s.radial_q + P(1, 1) * s.hoop_q, of_t = P(0, 0) * s.radial_t;
        const double qq = C(0, 0) * s.radial_q * s.radial_q + 2 * C(0, 4) * s.radial_q * s.hoop_q +
                          C(4, 4) * s.hoop_q * s.hoop_q + P(0, 0) * s.radial_qq + P(1, 1) * s.hoop_qq;
        const double qt = C(0, 0) * s.radial_q * s.radial_t + C(0, 4) * s.hoop_q * s.radial_t + P(0, 0) * s.radial_qt;
        const double tt = C(0, 0) * s.radial_t * s.radial_t;
        const std::array<double, 2> value = {1 - at, at}, change = {-1 / width, 1 / width};
        for (int k = 0; k < 2; ++k) {
          residual[i + k] += weight * (of_q * value[k] + of_t * change[k]);
          matrix.diagonal[i + k] +=
              weight * (qq * value[k] * value[k] + 2 * qt * value[k] * change[k] + tt * change[k] * change[k]);
        }
        matrix.beside[i] += weight * (qq * value[0] * value[1] + qt * (value[0] * change[1] + value[1] * change[0]) +
                                      tt * change[0] * change[1]);
      }
    }
    state.pressure = residual[0] / M_PI;  // its work is p pi dq
    matrix.diagonal[0] = 1;
    matrix.beside[0] = 0;
    residual[0] = 0;
    const Eigen::VectorXd change = matrix.solve(-residual);
    const double decrement = -change.dot(residual);
    if (std::abs(decrement) <= kDone * state.energy) return state;
    double share = 1, energy = energyOf(q + change, places);
    while (!(energy < state.energy + 1e-13 * std::abs(state.energy)) && share > 1e-6) {
      share /= 2;
      energy = energyOf(q + share * change, places);
    }
    q += share * change;
    state.energy = energy;
  }
  throw std::runtime_error("no equilibrium of a hole that a shaft opens was found");
}

}  // namespace microinjection
