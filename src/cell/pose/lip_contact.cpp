#include "cell/pose/lip_contact.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

namespace microinjection {
namespace {

/// Abscissas in (0, 1) and their weights.
struct LipQuadrature {
  std::array<double, LipContact::kHalf> at, weight;
  LipQuadrature() {
    using Gauss = boost::math::quadrature::gauss<double, LipContact::kHalf>;
    for (int i = 0; i < LipContact::kHalf; ++i) {
      const double x = Gauss::abscissa()[i / 2] * (i % 2 == 0 ? 1 : -1);
      at[i] = (1 + x) / 2;
      weight[i] = Gauss::weights()[i / 2] / 2;
    }
  }
};

const LipQuadrature& lipQuadrature() {
  static const LipQuadrature quadrature;
  return quadrature;
}

}  // namespace

/// In the half-plane at psi from the centre's azimuth: the core's point nearest to the centre.
struct LipContact::InHalfPlane {
  double along, across, up;  ///< m, from it to the centre: along the half-plane, normal to it, along the axis
  double distance() const { return std::sqrt(along * along + across * across + up * up); }
};

LipContact::LipContact(const PipetteMouth& mouth, double cell_radius, double contact_modulus)
    : reach_(cell_radius + mouth.edgeRadius()),
      inner_(mouth.crestRadius()),
      outer_(std::max(mouth.outerRadius() - mouth.edgeRadius(), mouth.crestRadius())),
      lowest_(mouth.edgeRadius()),
      side_(mouth.side()),
      foundation_(M_PI / 4 * contact_modulus * inner_) {}

LipContact::InHalfPlane LipContact::inHalfPlane(double radial, double height, double cosine, double sine) const {
  const double along = radial * cosine;
  return {along - std::clamp(along, inner_, outer_), -radial * sine, std::min(height - lowest_, 0.0)};
}

double LipContact::contactEnd(double radial, double height, bool edge_only) const {
  const double up = std::min(height - lowest_, 0.0);
  // About a circle of the core: the distance's square is r^2 + radial^2 + up^2 - 2 r radial cos(psi).
  const auto aboutCircle = [&](double r) {
    const double excess = r * r + radial * radial + up * up - reach_ * reach_, range = 2 * r * radial;
    return std::abs(excess) < range ? std::acos(excess / range) : (excess < 0 ? M_PI : 0.0);
  };
  const double inner_end = aboutCircle(inner_);
  if (edge_only || radial <= inner_) return inner_end;
  // The centre is over the flat end or outside: there the half-planes are nearer to it than the inner circle.
  const double leaves_flat = std::acos(inner_ / radial);
  if (inner_end > leaves_flat) return inner_end;
  const double across = (reach_ * reach_ - up * up) / (radial * radial);
  const double flat_end = across <= 0 ? 0.0 : std::asin(std::sqrt(std::min(across, 1.0)));
  if (radial <= outer_ || flat_end > std::acos(outer_ / radial)) return std::min(flat_end, leaves_flat);
  return aboutCircle(outer_);
}

LipContact::Forces LipContact::at(const Eigen::Vector3d& centre) const {
  Forces forces;
  const double radial = std::hypot(centre.x(), centre.y()), height = side_ * centre.z();
  if (radial > outer_ + reach_ || height < lowest_ - reach_) return forces;
  forces.angle = contactEnd(radial, height, false);
  if (forces.angle <= 0) return forces;
  const double c = radial > 0 ? centre.x() / radial : 1, s = radial > 0 ? centre.y() / radial : 0;
  const LipQuadrature& quadrature = lipQuadrature();
  for (int i = 0; i < kHalf; ++i) {
    const double psi = quadrature.at[i] * forces.angle, cosine = std::cos(psi), sine = std::sin(psi);
    const InHalfPlane near = inHalfPlane(radial, height, cosine, sine);
    const double distance = std::max(near.distance(), 1e-3 * reach_), overlap = std::max(reach_ - distance, 0.0);
    const double stiffness = foundation_ * quadrature.weight[i] * forces.angle;
    forces.energy += stiffness * overlap * overlap;  // of both points
    const double x = cosine * near.along - sine * near.across, y = sine * near.along + cosine * near.across;
    for (int mirrored = 0; mirrored < 2; ++mirrored) {
      const double sign = mirrored ? -1 : 1;
      Point& point = forces.points[2 * i + mirrored];
      point.normal = Eigen::Vector3d(c * x - s * sign * y, s * x + c * sign * y, side_ * near.up) / distance;
      point.stiffness = stiffness;
      point.push = stiffness * overlap;
      point.distance = distance;
    }
  }
  return forces;
}

double LipContact::leakingGap(const Eigen::Vector3d& centre) const {
  const double radial = std::hypot(centre.x(), centre.y()), height = side_ * centre.z();
  const double begin = contactEnd(radial, height, true), up = std::min(height - lowest_, 0.0);
  const LipQuadrature& quadrature = lipQuadrature();
  double mean = 0;
  for (int i = 0; i < kHalf; ++i) {
    const double psi = begin + quadrature.at[i] * (M_PI - begin);
    const double square = inner_ * inner_ + radial * radial + up * up - 2 * inner_ * radial * std::cos(psi);
    const double gap = std::max(std::sqrt(square) - reach_, 0.0);
    mean += quadrature.weight[i] * (1 - begin / M_PI) * gap * gap * std::sqrt(gap);
  }
  return std::pow(mean, 0.4);
}

}  // namespace microinjection
