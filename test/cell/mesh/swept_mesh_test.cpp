#include "cell/mesh/swept_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cell/mesh/section_mesher.h"

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

TEST(SweptMesh, HalfAndItsImageAreTheWhole) {
  SweepConfig whole_config = config(9e-6, 0), half_config = whole_config;
  half_config.half = true;
  half_config.segments = whole_config.segments / 2;
  const QuadraticMesh<3> whole = sweepSection(section(), whole_config), half = sweepSection(section(), half_config);
  EXPECT_EQ(2 * half.elements.size(), whole.elements.size());
  EXPECT_EQ(2 * half.facets.size(), whole.facets.size());  // the cut is none
  std::size_t in_plane = 0;
  for (const Eigen::Vector3d& x : half.nodes) {
    EXPECT_GE(x.y(), 0);
    in_plane += x.y() == 0;
    const auto same = [&](const Eigen::Vector3d& other) { return (other - x).norm() < 1e-9 * kRadius; };
    EXPECT_EQ(std::count_if(whole.nodes.begin(), whole.nodes.end(), same), 1) << x.transpose();
  }
  EXPECT_EQ(2 * half.nodes.size(), whole.nodes.size() + in_plane);
  half_config.pole_azimuth = 0.1;
  EXPECT_THROW(sweepSection(section(), half_config), std::invalid_argument);
}

}  // namespace
}  // namespace microinjection
