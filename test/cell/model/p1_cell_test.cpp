#include "cell/model/p1_cell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "base/errors.h"

namespace microinjection {
namespace {

using Eigen::Vector3d;

class P1CellTest : public testing::Test {
 protected:
  const Scene scene_;
  const P1Cell cell_{scene_};
};

TEST_F(P1CellTest, DefaultMeshIsOfTheSizeThatTheSimulatorCanAfford) {
  EXPECT_GT(cell_.mesh().vertices.size(), 500u);
  EXPECT_LT(cell_.mesh().vertices.size(), 1000u);
}

TEST_F(P1CellTest, HoldsTheVerticesUnderTheMouthWithTheirRim) {
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

TEST_F(P1CellTest, RayFindsThePoleFromEveryStart) {
  for (int start = 0; start < static_cast<int>(cell_.surface().triangles.size()); start += 13) {
    const auto hit = cell_.hit({1e-6, 2e-6, 50e-6}, {0, 0, -1}, start);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->point.norm() / scene_.radius(), 1, 0.01);
    EXPECT_GT(hit->normal.z(), 0.95);
    EXPECT_NEAR(hit->distance, 50e-6 - hit->point.z(), 1e-18);
  }
  EXPECT_FALSE(cell_.hit({40e-6, 0, 50e-6}, {0, 0, -1}));
}

TEST_F(P1CellTest, PatchIsUnderTheTip) {
  const TipPatch patch = cell_.patchAt({0, 0, 28e-6}, Vector3d::UnitZ());
  EXPECT_GE(patch.vertices.size(), 9u);
  std::vector<int> common;
  std::set_intersection(patch.vertices.begin(), patch.vertices.end(), cell_.heldVertices().begin(),
                        cell_.heldVertices().end(), std::back_inserter(common));
  EXPECT_TRUE(common.empty());
}

TEST(P1Cell, LayersAreMeshedAndHaveTheirMaterial) {
  Scene scene;
  scene.mesh.size = 12e-6;
  Scene::Layer core = scene.cell.layers.front();
  core.name = "core";
  core.outer_radius = 18e-6;
  core.material.young_modulus = 1e3;
  scene.cell.layers.push_back(core);
  const P1Cell cell(scene);
  EXPECT_EQ(std::set<int>(cell.mesh().layers.begin(), cell.mesh().layers.end()), (std::set<int>{0, 1}));
  const LayeredBody<3>& body = *cell.body();
  EXPECT_EQ(body.kind(), ElementKind::kP1);
  EXPECT_EQ(body.elementCount(), static_cast<int>(cell.mesh().tetrahedra.size()));
  // Stretched alike, the outer layer's elements store 17.9 times the energy.
  Eigen::VectorXd state = Eigen::VectorXd::Zero(body.stateSize());
  for (std::size_t v = 0; v < cell.mesh().vertices.size(); ++v) state.segment<3>(3 * v) = 0.1 * cell.mesh().vertices[v];
  double density[2] = {0, 0};
  LocalEnergy local;
  for (int e = 0; e < body.elementCount(); ++e) {
    ASSERT_TRUE(body.evaluate(e, state, Order::kEnergy, local));
    density[cell.mesh().layers[e]] = local.energy / tetrahedronVolume(cell.mesh(), e);
  }
  EXPECT_NEAR(density[0] / density[1], 17.9, 1e-9);
}

TEST(P1Cell, RefusesWhatTheLiveCellCannotDoAndNamesAllOfIt) {
  Scene scene;
  scene.needle.tip.shape = "hemisphere";
  scene.cell.layers.front().surface_tension = 1e-3;
  scene.cell.layers.push_back(scene.cell.layers.front());
  scene.cell.layers.back().name = "core";
  scene.cell.layers.back().outer_radius = 20e-6;
  scene.cell.layers.back().surface_tension = 0;
  scene.cell.layers.back().material.viscoelasticity.viscosity = 2;
  const auto errors = [&]() -> std::string {
    try {
      const P1Cell cell(scene);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  const std::string layered = errors();
  for (const char* part :
       {"needle/tip/shape = hemisphere: must be disc", "cell/layers/0/surface_tension = 0.001 N/m: must be 0",
        "cell/layers/1/material/viscoelasticity: must be left out", "not possible with linear tetrahedra"}) {
    EXPECT_NE(layered.find(part), std::string::npos) << part << "\nis not in\n" << layered;
  }
  EXPECT_EQ(layered.find("layers/1/surface_tension"), std::string::npos) << layered;
  EXPECT_EQ(layered.find("layers/0/material"), std::string::npos) << layered;

  scene.needle.tip.shape = "disc";
  scene.cell.layers.resize(1);
  const std::string homogeneous = errors();
  EXPECT_NE(homogeneous.find("cell/surface_tension"), std::string::npos) << homogeneous;
  scene.cell.layers.front().surface_tension = 0;
  EXPECT_EQ(errors(), "");
}

}  // namespace
}  // namespace microinjection
