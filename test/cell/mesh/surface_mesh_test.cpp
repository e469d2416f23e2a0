#include "cell/mesh/surface_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <stdexcept>

#include "cell/mesh/shapes.h"

namespace microinjection {
namespace {

TEST(SurfaceMesh, OfACubeIsClosedAndFacesOutwards) {
  const TetMesh mesh = unitCube(2);
  const SurfaceMesh surface = extractSurface(mesh);
  EXPECT_EQ(surface.triangles.size(), 6u * 4 * 2);
  EXPECT_EQ(surface.vertices.size(), 26u);  // all 27 but the centre
  double volume = 0;                        // by the divergence theorem
  for (size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    volume += surface.vertices[a].dot(surface.vertices[b].cross(surface.vertices[c])) / 6;
    const Eigen::Vector3d centre = (surface.vertices[a] + surface.vertices[b] + surface.vertices[c]) / 3;
    EXPECT_GT(surface.normal(t).dot(centre - Eigen::Vector3d(0.5, 0.5, 0.5)), 0.4);
  }
  EXPECT_NEAR(volume, 1, 1e-14);
  for (size_t v = 0; v < surface.vertices.size(); ++v) {
    EXPECT_EQ(surface.vertices[v], mesh.vertices[surface.mesh_vertices[v]]);
  }
}

TEST(SurfaceMesh, NeighboursShareTheEdge) {
  const SurfaceMesh surface = extractSurface(unitCube(2));
  for (size_t t = 0; t < surface.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int from = surface.triangles[t][i], to = surface.triangles[t][(i + 1) % 3];
      const std::array<int, 3>& other = surface.triangles[surface.neighbours[t][i]];
      bool shared = false;
      for (int j = 0; j < 3; ++j) shared = shared || (other[j] == to && other[(j + 1) % 3] == from);
      EXPECT_TRUE(shared);
    }
  }
}

TEST(SurfaceMesh, RefusesABoundaryThatIsNoSurface) {
  TetMesh mesh;  // two tetrahedra that share an edge only
  mesh.vertices = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  mesh.tetrahedra = {{0, 2, 3, 1}, {0, 4, 5, 1}};
  EXPECT_THROW(extractSurface(mesh), std::invalid_argument);
}

}  // namespace
}  // namespace microinjection
