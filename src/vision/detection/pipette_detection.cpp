#include "vision/detection/pipette_detection.h"

#include <algorithm>
#include <cmath>

namespace microinjection {

void PipetteDetection::setCovariance(double along, double across) {
  const double c = std::cos(direction), s = std::sin(direction);
  Eigen::Matrix2d turn;
  turn << c, -s, s, c;
  covariance = turn * Eigen::Vector2d(along * along, across * across).asDiagonal() * turn.transpose();
}

void PipetteDetection::hear(const Finding& second_eye) {
  second = second_eye;
  if (finding.isFound()) finding = second_eye;
}

double PipetteDetection::deviationAlong() const {
  const Eigen::Vector2d axis(std::cos(direction), std::sin(direction));
  return std::sqrt(std::max(0.0, axis.dot(covariance * axis)));
}

}  // namespace microinjection
