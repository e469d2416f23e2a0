#include "vision/calibration/camera_model.h"

namespace microinjection {
namespace {

constexpr double kPi = 3.14159265358979323846;

double directionOf(const Eigen::Vector2d& vector) { return std::atan2(vector.y(), vector.x()); }

/// In (-pi, pi].
double wrapped(double angle) { return std::remainder(angle, 2 * kPi); }

}  // namespace

bool setImageAxes(CalibrationVector<double>& p, const Eigen::Vector2d& x, const Eigen::Vector2d& z) {
  const bool mirrored = x.x() * z.y() - x.y() * z.x() > 0;
  const double turn = directionOf(x) - directionOf(z);
  p[kPixelSize] = 1 / std::sqrt(x.norm() * z.norm());
  p[kAxisRatio] = z.norm() / x.norm();
  p[kSkew] = wrapped(mirrored ? 1.5 * kPi - turn : turn - 0.5 * kPi);
  // Directions grow clockwise on the screen, because the image's y points down.
  p[kAngle] = wrapped(-(directionOf(z) + 0.5 * kPi + (mirrored ? -0.5 : 0.5) * p[kSkew]));
  return mirrored;
}

}  // namespace microinjection
