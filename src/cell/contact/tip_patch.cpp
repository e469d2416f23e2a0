#include "cell/contact/tip_patch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "cell/contact/ray_cast.h"

namespace microinjection {
namespace {

double bodyRadius(const SurfaceMesh& surface) {
  double squared = 0;
  for (const Eigen::Vector3d& vertex : surface.vertices) squared = std::max(squared, vertex.squaredNorm());
  return std::sqrt(squared);
}

int nearestVertex(const SurfaceMesh& surface, const Eigen::Vector3d& point) {
  const auto nearer = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (a - point).squaredNorm() < (b - point).squaredNorm();
  };
  const auto nearest = std::min_element(surface.vertices.begin(), surface.vertices.end(), nearer);
  return surface.mesh_vertices[nearest - surface.vertices.begin()];
}

}  // namespace

TipPatch findTipPatch(const SurfaceMesh& surface, const Eigen::Vector3d& point, const Eigen::Vector3d& axis,
                      double radius) {
  constexpr double kTolerance = 1e-6;
  const Eigen::Vector3d direction = axis.normalized();
  TipPatch patch;
  for (size_t i = 0; i < surface.vertices.size(); ++i) {
    const Eigen::Vector3d& vertex = surface.vertices[i];
    const double distance = direction.cross(vertex - point).norm();
    if (vertex.dot(direction) > 0 && distance <= radius * (1 + kTolerance)) {
      patch.vertices.push_back(surface.mesh_vertices[i]);
    }
  }
  if (!patch.vertices.empty()) return patch;

  const Eigen::Vector3d foot = point - direction * point.dot(direction);
  const Eigen::Vector3d outside = foot + 2 * bodyRadius(surface) * direction;
  if (const std::optional<SurfaceHit> hit = castRay(surface, outside, -direction)) {
    for (int corner : surface.triangles[hit->triangle]) patch.vertices.push_back(surface.mesh_vertices[corner]);
    std::sort(patch.vertices.begin(), patch.vertices.end());
  } else {
    patch.vertices.push_back(nearestVertex(surface, point));
  }
  return patch;
}

}  // namespace microinjection
