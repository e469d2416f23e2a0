#include "operation/teleoperation/device_axes_fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace microinjection {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr const char* kNames[] = {"right", "away", "up"};

int axisOf(const Eigen::Vector3d& motion) {
  Eigen::Index axis = 0;
  motion.cwiseAbs().maxCoeff(&axis);
  return static_cast<int>(axis);
}

Eigen::Vector3d directionOf(const Eigen::Vector3d& motion) {
  const int axis = axisOf(motion);
  return std::copysign(1.0, motion[axis]) * Eigen::Vector3d::Unit(axis);
}

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));  // exact for small angles, too
}

/// `format` has one %.1f.
std::string text(const char* format, double value) {
  char buffer[160];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

}  // namespace

std::string DeviceAxesFit::add(const Eigen::Vector3d& motion) {
  if (!motion.allFinite()) return "the motion is not finite";
  if (motion.norm() < kShortest)
    return text("the hand moved %.1f mm", 1e3 * motion.norm()) + text(": move it %.0f mm or more", 1e3 * kShortest);
  const double angle = angleBetween(motion, directionOf(motion)) / kDegree;
  if (angle > kWidest)
    return text("the motion is %.1f degrees off the device's nearest axis", angle) +
           text(": at most %.0f; move it straight", kWidest);
  for (int i = 0; i < motions(); ++i) {
    if (axisOf(motions_[i]) == axisOf(motion))
      return std::string("the motion is along the same axis of the device as the motion ") + kNames[i];
  }
  if (motions() == 2 && directionOf(motions_[0]).cross(directionOf(motions_[1])).dot(motion) < 0)
    return "the three motions are mirrored: one of them went the opposite way, or the device's axes are left-handed";
  motions_.push_back(motion);
  return "";
}

void DeviceAxesFit::removeLast() {
  if (!motions_.empty()) motions_.pop_back();
}

std::string DeviceAxesFit::next() const { return complete() ? "" : kNames[motions()]; }

std::string DeviceAxesFit::axes() const {
  std::string axes;
  for (const Eigen::Vector3d& motion : motions_) {
    const int axis = axisOf(motion);
    if (!axes.empty()) axes += ' ';
    if (motion[axis] < 0) axes += '-';
    axes += static_cast<char>('x' + axis);
  }
  return axes;
}

double DeviceAxesFit::angleToAxis() const {
  double largest = 0;
  for (const Eigen::Vector3d& motion : motions_) largest = std::max(largest, angleBetween(motion, directionOf(motion)));
  return largest;
}

double DeviceAxesFit::angleToSquare() const {
  double largest = 0;
  for (int i = 0; i < motions(); ++i) {
    for (int j = 0; j < i; ++j)
      largest = std::max(largest, std::abs(angleBetween(motions_[i], motions_[j]) - M_PI / 2));
  }
  return largest;
}

}  // namespace microinjection
