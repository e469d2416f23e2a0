#include "operation/display/triangle_soup.h"

#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace microinjection {

TriangleSoup lathe(const std::vector<Eigen::Vector2d>& profile, int segments) {
  if (segments < 3) throw std::invalid_argument("lathe: segments must be at least 3");
  TriangleSoup soup;
  const auto at = [&](std::size_t ring, int segment) -> Eigen::Vector3d {
    const double angle = 2 * M_PI * (segment % segments) / segments;
    const Eigen::Vector2d& p = profile[ring];
    return {p.x() * std::cos(angle), p.x() * std::sin(angle), p.y()};
  };
  for (std::size_t ring = 0; ring + 1 < profile.size(); ++ring) {
    for (int segment = 0; segment < segments; ++segment) {
      const Eigen::Vector3d a = at(ring, segment), b = at(ring, segment + 1);
      const Eigen::Vector3d c = at(ring + 1, segment), d = at(ring + 1, segment + 1);
      if (profile[ring].x() > 0) soup.add(a, b, d);
      if (profile[ring + 1].x() > 0) soup.add(a, d, c);
    }
  }
  return soup;
}

}  // namespace microinjection
