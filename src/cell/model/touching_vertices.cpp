#include "cell/model/touching_vertices.h"

#include <cmath>
#include <cstddef>
#include <optional>

#include "cell/contact/rounded_tip.h"

namespace microinjection {

std::vector<std::uint32_t> touchingVertices(const Scene::Tip& tip, const Eigen::Vector3d& position,
                                            const std::vector<Eigen::Vector3d>& vertices) {
  constexpr double kNear = 0.05;  // of the radius
  const double near = kNear * tip.radius;
  std::optional<RoundedTip> rounded;
  if (tip.rounded()) rounded = RoundedTip::make(tip.shape, tip.radius, tip.edge_radius);
  std::vector<std::uint32_t> result;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Eigen::Vector3d from_tip = vertices[i] - position;
    const bool touches = rounded ? rounded->distance(from_tip) < near
                                 : from_tip.head<2>().norm() < tip.radius + near && std::abs(from_tip.z()) < near;
    if (touches) result.push_back(static_cast<std::uint32_t>(i));
  }
  return result;
}

}  // namespace microinjection
