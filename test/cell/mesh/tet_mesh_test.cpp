#include "cell/mesh/tet_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "cell/mesh/mesh_checks.h"
#include "cell/mesh/shapes.h"

namespace microinjection {
namespace {

TEST(TetMesh, VolumesAreSignedAndAddUp) {
  const TetMesh mesh = unitCube(3);
  EXPECT_EQ(mesh.tetrahedra.size(), 6u * 27);
  for (int t = 0; t < 162; ++t) EXPECT_NEAR(tetrahedronVolume(mesh, t), 1.0 / 162, 1e-15);
  EXPECT_NEAR(meshVolume(mesh), 1, 1e-13);
  TetMesh turned = mesh;
  std::swap(turned.tetrahedra[0][0], turned.tetrahedra[0][1]);
  EXPECT_NEAR(tetrahedronVolume(turned, 0), -1.0 / 162, 1e-15);
}

TEST(TetMesh, RadiusRatioOfKnownShapes) {
  TetMesh regular;
  regular.vertices = {{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}};
  regular.tetrahedra = {{0, 1, 2, 3}};
  EXPECT_NEAR(std::abs(radiusRatio(regular, 0)), 1, 1e-14);
  // Corner of a unit cube: inscribed radius (3 - sqrt(3)) / 6, circumscribed sqrt(3) / 2.
  TetMesh corner;
  corner.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  corner.tetrahedra = {{0, 1, 2, 3}};
  EXPECT_NEAR(radiusRatio(corner, 0), 3 * (3 - std::sqrt(3)) / 6 / (std::sqrt(3) / 2), 1e-14);
  corner.vertices[3] = {0.3, 0.3, 1e-9};
  EXPECT_LT(radiusRatio(corner, 0), 1e-6);
  corner.vertices[3] = {0, 0, -1};
  EXPECT_LT(worstRadiusRatio(corner), 0);
}

}  // namespace
}  // namespace microinjection
