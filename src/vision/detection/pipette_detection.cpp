#include "vision/detection/pipette_detection.h"

#include <cmath>

namespace microinjection {

void PipetteDetection::setCovariance(double along, double across) {
  const double c = std::cos(direction), s = std::sin(direction);
  Eigen::Matrix2d turn;
  turn << c, -s, s, c;
  covariance = turn * Eigen::Vector2d(along * along, across * across).asDiagonal() * turn.transpose();
}

}  // namespace microinjection
