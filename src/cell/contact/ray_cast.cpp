#include "cell/contact/ray_cast.h"

#include <Eigen/Geometry>
#include <cmath>

namespace microinjection {
namespace {

/// Relative tolerance of barycentric coordinates, so that an edge belongs to both of its triangles.
constexpr double kEdge = 1e-12;

/// Walks over triangles that face the ray, each time across an edge outside of which the ray
/// passes, to the triangle that it hits. Returns -1 when it reaches a triangle that does not face
/// the ray, or does not end.
int walk(const SurfaceMesh& surface, int start, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  int triangle = start, previous = -1;
  for (size_t steps = 0; steps <= surface.triangles.size(); ++steps) {
    if (surface.normal(triangle).dot(direction) >= 0) return -1;
    const std::array<int, 3>& corners = surface.triangles[triangle];
    int next = -1;
    double furthest = 0;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d a = surface.vertices[corners[i]] - origin;
      const Eigen::Vector3d b = surface.vertices[corners[(i + 1) % 3]] - origin;
      // Six times the signed volume of (ray, edge): positive when the ray passes on the far side of
      // the edge.
      const double outside = direction.dot(a.cross(b));
      if (outside > furthest && surface.neighbours[triangle][i] != previous) {
        furthest = outside;
        next = surface.neighbours[triangle][i];
      }
    }
    if (next < 0) return triangle;
    previous = triangle;
    triangle = next;
  }
  return -1;
}

}  // namespace

std::optional<SurfaceHit> intersectTriangle(const SurfaceMesh& surface, int triangle, const Eigen::Vector3d& origin,
                                            const Eigen::Vector3d& direction) {
  const std::array<int, 3>& corners = surface.triangles[triangle];
  const Eigen::Vector3d& a = surface.vertices[corners[0]];
  const Eigen::Vector3d edge_1 = surface.vertices[corners[1]] - a;
  const Eigen::Vector3d edge_2 = surface.vertices[corners[2]] - a;
  const Eigen::Vector3d p = direction.cross(edge_2);
  const double determinant = edge_1.dot(p);
  if (std::abs(determinant) <= kEdge * edge_1.norm() * p.norm()) return std::nullopt;
  const Eigen::Vector3d from_a = origin - a;
  const double u = from_a.dot(p) / determinant;
  const Eigen::Vector3d q = from_a.cross(edge_1);
  const double v = direction.dot(q) / determinant;
  const double parameter = edge_2.dot(q) / determinant;
  if (u < -kEdge || v < -kEdge || u + v > 1 + kEdge || parameter < 0) return std::nullopt;
  SurfaceHit hit;
  hit.point = origin + parameter * direction;
  hit.triangle = triangle;
  hit.normal = surface.normal(triangle);
  hit.distance = parameter * direction.norm();
  return hit;
}

std::optional<SurfaceHit> castRay(const SurfaceMesh& surface, const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& direction) {
  std::optional<SurfaceHit> nearest;
  for (size_t t = 0; t < surface.triangles.size(); ++t) {
    std::optional<SurfaceHit> hit = intersectTriangle(surface, static_cast<int>(t), origin, direction);
    if (hit && (!nearest || hit->distance < nearest->distance)) nearest = hit;
  }
  return nearest;
}

std::optional<SurfaceHit> castRayFrom(const SurfaceMesh& surface, int start, const Eigen::Vector3d& origin,
                                      const Eigen::Vector3d& direction) {
  if (start >= 0 && start < static_cast<int>(surface.triangles.size())) {
    const int triangle = walk(surface, start, origin, direction);
    std::optional<SurfaceHit> hit =
        triangle < 0 ? std::nullopt : intersectTriangle(surface, triangle, origin, direction);
    if (hit) return hit;
  }
  return castRay(surface, origin, direction);
}

}  // namespace microinjection
