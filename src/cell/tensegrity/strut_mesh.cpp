#include "cell/tensegrity/strut_mesh.h"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

namespace microinjection {
namespace {

constexpr double kCapHeight = 0.5;                                                             ///< of the circumradius
constexpr std::array<std::array<int, 3>, 3> kTriangles = {{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}};  ///< of the section

void addTetrahedron(TetMesh& mesh, std::array<int, 4> corners) {
  mesh.tetrahedra.push_back(corners);
  if (tetrahedronVolume(mesh, static_cast<int>(mesh.tetrahedra.size()) - 1) < 0) {
    std::swap(mesh.tetrahedra.back()[2], mesh.tetrahedra.back()[3]);
  }
}

}  // namespace

double StrutMesh::circumradius(double section) { return std::sqrt(section / (2.5 * std::sin(0.4 * M_PI))); }

double StrutMesh::secondMoment(double section) {
  const double radius = circumradius(section), side = 2 * radius * std::sin(0.2 * M_PI);
  return section / 24 * (6 * radius * radius - side * side);
}

StrutMesh::StrutMesh(const StrutMeshConfig& config, const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                     const Eigen::Vector3d& bow_direction) {
  const Eigen::Vector3d along = direction.normalized();
  const Eigen::Vector3d u = (bow_direction - bow_direction.dot(along) * along).normalized(), v = along.cross(u);
  const double radius = circumradius(config.section), cap = kCapHeight * radius;
  const auto line = [&](double distance) -> Eigen::Vector3d {
    return from + distance * along + config.bow * config.length * std::sin(M_PI * distance / config.length) * u;
  };
  mesh.vertices.push_back(from);
  for (int section = 0; section <= config.slices; ++section) {
    const Eigen::Vector3d middle = line(cap + (config.length - 2 * cap) * section / config.slices);
    for (int corner = 0; corner < kCorners; ++corner) {
      const double angle = 2 * M_PI * corner / kCorners;
      mesh.vertices.emplace_back(middle + radius * (std::cos(angle) * u + std::sin(angle) * v));
    }
  }
  mesh.vertices.emplace_back(from + config.length * along);
  for (const auto& [a, b, c] : kTriangles) {
    addTetrahedron(mesh, {firstApex(), vertex(0, a), vertex(0, b), vertex(0, c)});
    for (int slice = 0; slice < config.slices; ++slice) {
      // The diagonals of the prisms' sides alternate their direction from slice to slice.
      int low = slice, high = slice + 1;
      if (slice % 2 == 1) std::swap(low, high);
      addTetrahedron(mesh, {vertex(low, a), vertex(low, b), vertex(low, c), vertex(high, c)});
      addTetrahedron(mesh, {vertex(low, a), vertex(low, b), vertex(high, b), vertex(high, c)});
      addTetrahedron(mesh, {vertex(low, a), vertex(high, a), vertex(high, b), vertex(high, c)});
    }
    addTetrahedron(mesh, {lastApex(), vertex(config.slices, a), vertex(config.slices, b), vertex(config.slices, c)});
  }
  mesh.layers.assign(mesh.tetrahedra.size(), 0);
}

}  // namespace microinjection
