#include "cell/contact/tip_patch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cell/contact/ray_cast.h"
#include "cell/mesh/cell_mesher.h"
#include "cell/mesh/needle_cell.h"

namespace microinjection {
namespace {

using Eigen::Vector3d;

const CellMeshConfig kConfig = needleCell();
const double kCellRadius = kConfig.radii[0];

class TipPatchTest : public testing::Test {
 protected:
  const TetMesh mesh_ = makeCellMesh(kConfig);
  const SurfaceMesh surface_ = extractSurface(mesh_);
};

TEST_F(TipPatchTest, IsTheDiscWithItsRim) {
  const TipPatch patch = findTipPatch(surface_, {0, 0, kCellRadius}, Vector3d::UnitZ(), kTipRadius);
  int on_rim = 0;
  for (int v : patch.vertices) {
    const Vector3d& vertex = mesh_.vertices[v];
    EXPECT_GT(vertex.z(), 0);
    EXPECT_NEAR(vertex.norm(), kCellRadius, 1e-15);
    EXPECT_LE(vertex.head<2>().norm(), kTipRadius * (1 + 1e-6));
    if (vertex.head<2>().norm() > kTipRadius * (1 - 1e-9)) ++on_rim;
  }
  EXPECT_GE(on_rim, 8);
  EXPECT_TRUE(std::is_sorted(patch.vertices.begin(), patch.vertices.end()));
}

TEST_F(TipPatchTest, DependsOnTheLineOnly) {
  const Vector3d axis(0.1, 0.2, 1);
  const TipPatch one = findTipPatch(surface_, {1e-6, 0, kCellRadius}, axis, 3e-6);
  const TipPatch two =
      findTipPatch(surface_, Vector3d(1e-6, 0, kCellRadius) - 5e-6 * axis.normalized(), 7 * axis, 3e-6);
  EXPECT_EQ(one.vertices, two.vertices);
}

TEST_F(TipPatchTest, FarSideIsAnotherPatch) {
  const TipPatch patch = findTipPatch(surface_, {0, 0, kCellRadius}, -Vector3d::UnitZ(), 10e-6);
  ASSERT_FALSE(patch.vertices.empty());
  for (int v : patch.vertices) EXPECT_LT(mesh_.vertices[v].z(), 0);
}

TEST_F(TipPatchTest, FinerThanTheMeshItIsTheTriangle) {
  const auto hit = castRay(surface_, {20e-6, 15e-6, 60e-6}, {0, 0, -1});
  const Vector3d centre = [&] {
    const std::array<int, 3>& corners = surface_.triangles[hit->triangle];
    return Vector3d((surface_.vertices[corners[0]] + surface_.vertices[corners[1]] + surface_.vertices[corners[2]]) /
                    3);
  }();
  TipPatch patch = findTipPatch(surface_, centre, Vector3d::UnitZ(), 1e-9);
  std::vector<int> corners;
  for (int corner : surface_.triangles[hit->triangle]) corners.push_back(surface_.mesh_vertices[corner]);
  std::sort(corners.begin(), corners.end());
  EXPECT_EQ(patch.vertices, corners);
}

TEST_F(TipPatchTest, BesideTheCellItIsTheNearestVertex) {
  const Vector3d point(40e-6, 0, 0);
  const TipPatch patch = findTipPatch(surface_, point, Vector3d::UnitZ(), 1e-6);
  ASSERT_EQ(patch.vertices.size(), 1u);
  for (const Vector3d& vertex : surface_.vertices) {
    EXPECT_GE((vertex - point).norm(), (mesh_.vertices[patch.vertices[0]] - point).norm());
  }
}

}  // namespace
}  // namespace microinjection
