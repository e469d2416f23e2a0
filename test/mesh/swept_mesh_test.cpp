#include "mesh/swept_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "mesh/section_mesher.h"

namespace microinjection {
namespace {

constexpr double kRadius = 28e-6, kDisc = 3e-6, kHolding = 10e-6;  // m

QuadraticMesh<2> section() {
  SectionMeshConfig config;
  config.radii = {kRadius, 24e-6};
  config.vertices = {{kDisc, +1}, {kHolding, -1}};
  config.refinements = {{kDisc, +1, 0, 1.5e-6}};
  return makeQuadratic(makeSectionMesh(config), config.radii);
}

SweepConfig config(double offset, double azimuth) {
  SweepConfig result;
  result.pole_offset = offset;
  result.pole_azimuth = azimuth;
  result.disc_radius = kDisc;
  result.holding_radius = kHolding;
  return result;
}

class SweptMesh : public testing::TestWithParam<double> {};

TEST_P(SweptMesh, LayersStaySpheresAndTheDiscsEdgeIsAVerticalCylinders) {
  const double azimuth = 0.7;
  const QuadraticMesh<3> mesh = sweepSection(section(), config(GetParam(), azimuth));
  const Eigen::Vector2d line = GetParam() * Eigen::Vector2d(std::cos(azimuth), std::sin(azimuth));
  int on_edge = 0, on_holding = 0;
  for (const auto& facet : mesh.facets) {
    for (int node : facet.nodes) {
      const Eigen::Vector3d& x = mesh.nodes[node];
      EXPECT_NEAR(x.norm(), facet.layer == 0 ? kRadius : 24e-6, 1e-9 * kRadius);
      if (facet.layer != 0) continue;
      on_edge += x.z() > 0 && std::abs((x.head<2>() - line).norm() - kDisc) < 1e-9 * kDisc;
      on_holding += x.z() < 0 && std::abs(x.head<2>().norm() - kHolding) < 1e-9 * kHolding;
    }
  }
  EXPECT_GE(on_edge, 16);
  EXPECT_GE(on_holding, 16);
}

TEST_P(SweptMesh, FillsTheBall) {
  const QuadraticMesh<3> mesh = sweepSection(section(), config(GetParam(), 0));
  double volume = 0;
  for (const auto& e : mesh.elements) {
    const Eigen::Vector3d a = mesh.nodes[e[1]] - mesh.nodes[e[0]], b = mesh.nodes[e[2]] - mesh.nodes[e[0]];
    const double part = a.cross(b).dot(mesh.nodes[e[3]] - mesh.nodes[e[0]]) / 6;
    EXPECT_GT(part, 0);
    volume += part;
  }
  const double ball = 4 * M_PI / 3 * std::pow(kRadius, 3);
  EXPECT_LT(volume, ball);  // straight tetrahedra in a ball, eight around
  EXPECT_GT(volume, 0.85 * ball);
}

INSTANTIATE_TEST_SUITE_P(Offsets, SweptMesh, testing::Values(0.0, 5e-6, 10e-6, 18e-6));

TEST(SweptMesh, WantsThreeSegments) {
  SweepConfig few;
  few.segments = 2;
  EXPECT_THROW(sweepSection(section(), few), std::invalid_argument);
}

}  // namespace
}  // namespace microinjection
