#pragma once

#include <Eigen/Core>
#include <optional>

#include "cell/mesh/surface_mesh.h"

namespace microinjection {

/// Intersection of a ray and a surface.
struct SurfaceHit {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< m
  int triangle = -1;                                 ///< of the SurfaceMesh
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< outward, unit
  double distance = 0;                               ///< m, from the ray's origin
};

/// Intersection of a ray with one triangle after Moeller and Trumbore (1997), from either side;
/// edges and corners belong to the triangle. `direction` may have any length. Empty for a ray
/// parallel to the triangle's plane.
std::optional<SurfaceHit> intersectTriangle(const SurfaceMesh& surface, int triangle, const Eigen::Vector3d& origin,
                                            const Eigen::Vector3d& direction);

/// Nearest intersection over all triangles.
std::optional<SurfaceHit> castRay(const SurfaceMesh& surface, const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& direction);

/// As castRay, but walks from triangle `start` to its neighbours towards the ray, which visits a
/// few triangles when the needle has moved little since it hit `start`. Falls back to all triangles
/// when the walk does not end on a triangle that faces the ray. On a convex surface both give the
/// same result.
std::optional<SurfaceHit> castRayFrom(const SurfaceMesh& surface, int start, const Eigen::Vector3d& origin,
                                      const Eigen::Vector3d& direction);

}  // namespace microinjection
