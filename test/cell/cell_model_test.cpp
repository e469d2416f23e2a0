#include "cell/cell_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <vector>

namespace microinjection {
namespace {

using Eigen::Vector3d;

class CellModelTest : public testing::Test {
 protected:
  const Scene scene_;
  const CellModel cell_{scene_};
};

TEST_F(CellModelTest, DefaultMeshIsOfTheSizeThatTheSimulatorCanAfford) {
  EXPECT_GT(cell_.mesh().vertices.size(), 500u);
  EXPECT_LT(cell_.mesh().vertices.size(), 1000u);
}

TEST_F(CellModelTest, HoldsTheVerticesUnderTheMouthWithTheirRim) {
  int on_rim = 0;
  for (int v : cell_.heldVertices()) {
    const Vector3d& vertex = cell_.mesh().vertices[v];
    EXPECT_LT(vertex.z(), 0);
    EXPECT_NEAR(vertex.norm(), scene_.radius(), 1e-15);
    EXPECT_LE(vertex.head<2>().norm(), 10e-6 * (1 + 1e-6));
    if (vertex.head<2>().norm() > 10e-6 * (1 - 1e-9)) ++on_rim;
  }
  EXPECT_GE(on_rim, 8);
}

TEST_F(CellModelTest, RayFindsThePoleFromEveryStart) {
  for (int start = 0; start < static_cast<int>(cell_.surface().triangles.size()); start += 13) {
    const auto hit = cell_.hit({1e-6, 2e-6, 50e-6}, {0, 0, -1}, start);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->point.norm() / scene_.radius(), 1, 0.01);
    EXPECT_GT(hit->normal.z(), 0.95);
    EXPECT_NEAR(hit->distance, 50e-6 - hit->point.z(), 1e-18);
  }
  EXPECT_FALSE(cell_.hit({40e-6, 0, 50e-6}, {0, 0, -1}));
}

TEST_F(CellModelTest, PatchIsUnderTheTip) {
  const TipPatch patch = cell_.patchAt({0, 0, 28e-6}, Vector3d::UnitZ());
  EXPECT_GE(patch.vertices.size(), 9u);
  std::vector<int> common;
  std::set_intersection(patch.vertices.begin(), patch.vertices.end(), cell_.heldVertices().begin(),
                        cell_.heldVertices().end(), std::back_inserter(common));
  EXPECT_TRUE(common.empty());
}

}  // namespace
}  // namespace microinjection
