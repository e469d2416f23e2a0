#include "cell/pose/lip_suction.h"

#include <algorithm>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <cmath>
#include <complex>

namespace microinjection {
namespace {

constexpr double kLeaves = 0.17;  // of the lip's edge radius, beyond the liquid's disc: where the slope is taken

double filmShare(double t) { return 1 / (1 + t * t * std::sqrt(t)); }

/// Integral of filmShare() from 0 to t, by partial fractions in w = sqrt(u): the poles are the fifth roots of -1.
double reciprocalIntegral(double t) {
  const double w = std::sqrt(t);
  double sum = std::log1p(w) / 2;
  for (const double angle : {M_PI / 5, 3 * M_PI / 5}) {
    const std::complex<double> root = std::polar(1.0, angle);
    sum += std::real(root * root * std::log(1.0 - w * std::conj(root)));
  }
  return -0.8 * sum;
}

}  // namespace

LipSuction::LipSuction(const PipetteMouth& mouth, const CellMotionConfig& config)
    : swallows_(mouth.innerRadius() >= config.radius),
      viscosity_(config.viscosity),
      edge_(mouth.edgeRadius()),
      crest_(mouth.crestRadius()),
      radius_(config.radius),
      modulus_(config.contactModulus()) {
  const double a = mouth.innerRadius(), relative = 1 / (1 / config.radius + 1 / edge_);
  seal_ = swallows_ ? config.radius : mouth.touchRadius(config.radius);
  // A sphere that passes the mouth is drawn to a place behind it.
  middle_ = swallows_ ? 2 * config.radius
                      : std::sqrt(config.radius * config.radius - seal_ * seal_) - mouth.touchDistance(config.radius);
  touch_ = swallows_ ? 2 * config.radius : std::sqrt(config.radius * config.radius - seal_ * seal_);
  gap_coefficient_ = 9.0 / 4 * viscosity_ * std::sqrt(2 * relative) / seal_;
  series_ = 3 * viscosity_ / (2 * a * a * a) + 8 * viscosity_ * config.bore_length / (M_PI * std::pow(a, 4));
}

double LipSuction::area() const { return M_PI * seal_ * seal_; }

double LipSuction::releasedRadius(double suction) const {
  if (swallows_) return seal_;
  const double k = seal_ / (seal_ + kLeaves * edge_);
  const double slope = 4 / M_PI * suction / modulus_ * (boost::math::ellint_1(k) - boost::math::ellint_2(k));
  const double angle = std::min(std::asin(seal_ / radius_) + slope, M_PI / 2);
  return crest_ - edge_ * std::sin(angle);
}

double LipSuction::lateralStiffness(double suction) const {
  if (swallows_) return 0;
  const double sine = seal_ / radius_, cosine = std::sqrt(1 - sine * sine);
  const double line = suction * seal_ / (2 * cosine), relative = 1 / (1 / radius_ + 1 / edge_);
  const double width = std::min(std::sqrt(4 * line * relative / (M_PI * modulus_)), seal_);
  const double yields = 2 / (M_PI * modulus_) * (std::log(16 * seal_ / width) - 2);  // m^2/N, of a line load
  return M_PI * seal_ * sine * sine / yields;
}

double LipSuction::notchConductance(double area) const {
  if (area <= 0) return 0;
  const double r = std::sqrt(area / M_PI);
  return 1 / (3 * viscosity_ / (r * r * r) + 16 * viscosity_ * edge_ / (M_PI * std::pow(r, 4)));
}

double LipSuction::scale(double notch) const { return std::pow(gap_coefficient_ * (1 / series_ + notch), 0.4); }

double LipSuction::share(double gap, double notch) const {
  const double closed = 1 / (1 + series_ * notch), g0 = scale(notch), end = filmShare(seal_ / g0);
  if (gap <= 0) return closed;
  return gap < seal_ ? closed * (filmShare(gap / g0) - end) / (1 - end) : 0;
}

double LipSuction::shareIntegral(double gap, double notch) const {
  const double closed = 1 / (1 + series_ * notch), g0 = scale(notch), end = filmShare(seal_ / g0);
  if (gap <= 0) return closed * gap;
  const double film = std::min(gap, seal_);
  return closed * (g0 * reciprocalIntegral(film / g0) - end * film) / (1 - end);
}

}  // namespace microinjection
