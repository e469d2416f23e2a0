#include "vision/pipette/pipette_detection.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kConfirmed = 0.04;  // of the half width, standard deviation of an end that is told by a second eye

}  // namespace

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

void PipetteDetection::confirm() {
  const Eigen::Vector2d axis(std::cos(direction), std::sin(direction));
  if (!confirmed) confirmed = clearness;
  if (!which_end || !finding.hasValues()) return;
  finding = Finding::found();
  covariance += std::pow(kConfirmed * half_width, 2) * axis * axis.transpose();
}

cv::Point2d PipetteDetection::inAxes(const cv::Point2d& place) const {
  const cv::Point2d axis(std::cos(direction), std::sin(direction)), away = place - end;
  return {away.dot(axis), axis.cross(away)};
}

double PipetteDetection::deviationAlong() const {
  const Eigen::Vector2d axis(std::cos(direction), std::sin(direction));
  return std::sqrt(std::max(0.0, axis.dot(covariance * axis)));
}

}  // namespace microinjection
