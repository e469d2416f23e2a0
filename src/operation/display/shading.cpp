#include "operation/display/shading.h"

#include <algorithm>

namespace microinjection {

double lampLight(const Eigen::Vector3d& normal) {
  static const Eigen::Vector3d to_lamp = Eigen::Vector3d(-0.4, -0.7, 0.6).normalized();
  constexpr double kAmbient = 0.65, kDiffuse = 0.45, kSky = 0.08;
  return kAmbient + kDiffuse * std::max(0.0, normal.dot(to_lamp)) + kSky * normal.z();
}

Colour shaded(const Colour& colour, double light) {
  const auto scaled = [light](float channel) {
    return static_cast<float>(std::clamp(light * static_cast<double>(channel), 0.0, 1.0));
  };
  return {scaled(colour.r), scaled(colour.g), scaled(colour.b), colour.a};
}

}  // namespace microinjection
