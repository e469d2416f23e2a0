#include "mesh/cell_mesher.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "base/errors.h"
#include "mesh/surface_mesh.h"

namespace microinjection {
namespace {

constexpr double kPi = 3.14159265358979323846;

CellMeshConfig withOffset(double x, double y) {
  CellMeshConfig config;
  config.offset = {x, y};
  return config;
}

/// Needles at the pole, beside it, and far out where the surface is steep.
class CellMesher : public testing::TestWithParam<CellMeshConfig> {
 protected:
  const CellMeshConfig config_ = GetParam();
  const double radius_ = config_.diameter / 2;
  const TetMesh mesh_ = makeCellMesh(config_);
  const SurfaceMesh surface_ = extractSurface(mesh_);
};

/// What the facets cut off the ball: over a triangle of area A the cap's height is (rho^2 - s^2) / 2R at distance s
/// from its circumcentre, whose integral is A (a^2 + b^2 + c^2) / 24 R, a, b, c the edges; to first order in (edge /
/// R)^2.
double facetingDeficit(const SurfaceMesh& surface, double radius) {
  double deficit = 0;
  for (const std::array<int, 3>& triangle : surface.triangles) {
    const Eigen::Vector3d& a = surface.vertices[triangle[0]];
    const Eigen::Vector3d ab = surface.vertices[triangle[1]] - a, ac = surface.vertices[triangle[2]] - a;
    const double area = ab.cross(ac).norm() / 2;
    deficit += area * (ab.squaredNorm() + ac.squaredNorm() + (ab - ac).squaredNorm()) / (24 * radius);
  }
  return deficit;
}

TEST_P(CellMesher, VolumeIsTheBallsLessTheFacets) {
  const double ball = kPi * std::pow(config_.diameter, 3) / 6;
  const double deficit = ball - meshVolume(mesh_), expected = facetingDeficit(surface_, radius_);
  EXPECT_GT(deficit, 0);
  EXPECT_LT(deficit, 0.06 * ball);
  EXPECT_NEAR(deficit / expected, 1, 0.25);  // edges of half a radius: (1/2)^2
}

TEST_P(CellMesher, ElementsArePositiveAndWellShaped) {
  for (size_t t = 0; t < mesh_.tetrahedra.size(); ++t) EXPECT_GT(radiusRatio(mesh_, static_cast<int>(t)), 0.15);
}

TEST_P(CellMesher, SurfaceVerticesLieOnTheSphere) {
  for (const Eigen::Vector3d& vertex : surface_.vertices) EXPECT_NEAR(vertex.norm() / radius_, 1, 1e-12);
}

/// Vertices of the surface at `radius` from the vertical line through `centre`, by angle.
std::vector<int> onCircle(const SurfaceMesh& surface, const Eigen::Vector2d& centre, double radius, double side) {
  std::vector<std::pair<double, int>> found;
  for (size_t v = 0; v < surface.vertices.size(); ++v) {
    const Eigen::Vector2d from = surface.vertices[v].head<2>() - centre;
    if (surface.vertices[v].z() * side > 0 && std::abs(from.norm() / radius - 1) < 1e-9) {
      found.emplace_back(std::atan2(from.y(), from.x()), static_cast<int>(v));
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<int> vertices;
  for (const auto& entry : found) vertices.push_back(entry.second);
  return vertices;
}

void expectClosedPolygon(const SurfaceMesh& surface, const std::vector<int>& vertices) {
  ASSERT_GE(vertices.size(), 8u);
  std::set<std::pair<int, int>> edges;
  for (const std::array<int, 3>& triangle : surface.triangles) {
    for (int i = 0; i < 3; ++i) edges.emplace(triangle[i], triangle[(i + 1) % 3]);
  }
  for (size_t i = 0; i < vertices.size(); ++i) {
    EXPECT_EQ(edges.count({vertices[i], vertices[(i + 1) % vertices.size()]}), 1u);
  }
}

TEST_P(CellMesher, EdgesFollowTheCircleOfTheTip) {
  expectClosedPolygon(surface_, onCircle(surface_, config_.offset, config_.tip_radius, +1));
}

TEST_P(CellMesher, EdgesFollowTheCircleOfTheHoldingPipette) {
  expectClosedPolygon(surface_, onCircle(surface_, {0, 0}, config_.contact_radius, -1));
}

TEST_P(CellMesher, PunctureZoneIsDenser) {
  double inside = 0, outside = 0;
  int count_inside = 0, count_outside = 0;
  for (size_t t = 0; t < mesh_.tetrahedra.size(); ++t) {
    const std::array<int, 4>& c = mesh_.tetrahedra[t];
    const Eigen::Vector3d centre =
        (mesh_.vertices[c[0]] + mesh_.vertices[c[1]] + mesh_.vertices[c[2]] + mesh_.vertices[c[3]]) / 4;
    const double edge = std::cbrt(tetrahedronVolume(mesh_, static_cast<int>(t)) * 6 * std::sqrt(2));
    const double from_entry = (centre - config_.entry()).norm();
    if (from_entry < config_.zone_diameter / 2) inside += edge, ++count_inside;
    if (from_entry > config_.diameter - config_.zone_diameter / 2) outside += edge, ++count_outside;
  }
  ASSERT_GT(count_inside, 100);
  ASSERT_GT(count_outside, 10);
  inside /= count_inside;
  outside /= count_outside;
  EXPECT_NEAR(inside / (config_.size / config_.density), 1, 0.3);
  EXPECT_GT(outside / inside, 0.6 * config_.density);
}

INSTANTIATE_TEST_SUITE_P(Offsets, CellMesher,
                         testing::Values(withOffset(0, 0), withOffset(4e-6, -3e-6), withOffset(-15e-6, 10e-6)));

TEST(CellMesherSize, GrowsFromTheZoneOutwards) {
  const CellMeshConfig config;
  const Eigen::Vector3d pole(0, 0, 28e-6);
  EXPECT_DOUBLE_EQ(config.sizeAt(pole), 12e-6 / 5);
  EXPECT_DOUBLE_EQ(config.sizeAt(pole - Eigen::Vector3d(0, 0, 15e-6)), 12e-6 / 5);
  EXPECT_DOUBLE_EQ(config.sizeAt(pole - Eigen::Vector3d(0, 0, 18e-6)), 12e-6 / 5 + 1e-6);
  EXPECT_DOUBLE_EQ(config.sizeAt(-pole), 12e-6);
}

TEST(CellMesherDeterminism, SameConfigurationSameMesh) {
  const TetMesh one = makeCellMesh(withOffset(1e-6, 0)), two = makeCellMesh(withOffset(1e-6, 0));
  EXPECT_EQ(one.vertices, two.vertices);
  EXPECT_EQ(one.tetrahedra, two.tetrahedra);
}

TEST(CellMeshConfig, RefusesWhatCannotBeMeshed) {
  CellMeshConfig config;
  config.diameter = -1;
  config.density = 0.5;
  try {
    makeCellMesh(config);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("diameter = -1"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("density = 0.5"), std::string::npos);
  }
  EXPECT_THROW(makeCellMesh(withOffset(25e-6, 0)), ConfigError);  // the disc would hang over the edge
}

}  // namespace
}  // namespace microinjection
