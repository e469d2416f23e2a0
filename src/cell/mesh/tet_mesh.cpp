#include "cell/mesh/tet_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace microinjection {

double tetrahedronVolume(const TetMesh& mesh, int tetrahedron) {
  const std::array<int, 4>& corners = mesh.tetrahedra[tetrahedron];
  const Eigen::Vector3d& a = mesh.vertices[corners[0]];
  return (mesh.vertices[corners[1]] - a).cross(mesh.vertices[corners[2]] - a).dot(mesh.vertices[corners[3]] - a) / 6;
}

double radiusRatio(const TetMesh& mesh, int tetrahedron) {
  const std::array<int, 4>& corners = mesh.tetrahedra[tetrahedron];
  const Eigen::Vector3d& origin = mesh.vertices[corners[0]];
  const Eigen::Vector3d a = mesh.vertices[corners[1]] - origin;
  const Eigen::Vector3d b = mesh.vertices[corners[2]] - origin;
  const Eigen::Vector3d c = mesh.vertices[corners[3]] - origin;
  const double six_volumes = a.cross(b).dot(c);
  const double two_areas = a.cross(b).norm() + b.cross(c).norm() + c.cross(a).norm() + (b - a).cross(c - a).norm();
  // r_in = 3 V / area; R_circum = |a^2 (b x c) + b^2 (c x a) + c^2 (a x b)| / (12 V)
  const double circum =
      (a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a) + c.squaredNorm() * a.cross(b)).norm();
  if (six_volumes == 0) return 0;
  return 3 * (six_volumes / two_areas) * (2 * std::abs(six_volumes) / circum);
}

double worstRadiusRatio(const TetMesh& mesh) {
  double worst = std::numeric_limits<double>::infinity();
  for (size_t t = 0; t < mesh.tetrahedra.size(); ++t) worst = std::min(worst, radiusRatio(mesh, static_cast<int>(t)));
  return worst;
}

}  // namespace microinjection
