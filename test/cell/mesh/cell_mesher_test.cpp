#include "cell/mesh/cell_mesher.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <utility>

#include "cell/mesh/circle_on_sphere.h"
#include "cell/mesh/mesh_checks.h"
#include "cell/mesh/needle_cell.h"
#include "cell/mesh/surface_mesh.h"

namespace microinjection {
namespace {

/// Made once for each needle.
const TetMesh& needleMesh(const Eigen::Vector2d& offset) {
  static std::map<std::pair<double, double>, TetMesh> meshes;
  TetMesh& mesh = meshes[{offset.x(), offset.y()}];
  if (mesh.vertices.empty()) mesh = makeCellMesh(needleCell(offset));
  return mesh;
}

/// Needles at the pole, beside it, and far out where the surface is steep.
class CellMesher : public testing::TestWithParam<Eigen::Vector2d> {
 protected:
  const Eigen::Vector2d offset_ = GetParam();
  const CellMeshConfig config_ = needleCell(offset_);
  const double radius_ = config_.radii.front();
  const TetMesh& mesh_ = needleMesh(offset_);
  const SurfaceMesh surface_ = extractSurface(mesh_);
};

TEST_P(CellMesher, VolumeIsTheBallsLessTheFacets) {
  const double ball = 4 * M_PI * std::pow(radius_, 3) / 3;
  const double deficit = ball - meshVolume(mesh_), expected = facetingDeficit(surface_, radius_);
  EXPECT_GT(deficit, 0);
  EXPECT_LT(deficit, 0.06 * ball);
  EXPECT_NEAR(deficit / expected, 1, 0.25);  // edges of half a radius: (1/2)^2
}

TEST_P(CellMesher, ElementsArePositiveAndWellShaped) {
  for (size_t t = 0; t < mesh_.tetrahedra.size(); ++t) EXPECT_GT(radiusRatio(mesh_, static_cast<int>(t)), 0.15);
  EXPECT_EQ(mesh_.layers, std::vector<int>(mesh_.tetrahedra.size(), 0));
}

TEST_P(CellMesher, SurfaceVerticesLieOnTheSphere) {
  for (const Eigen::Vector3d& vertex : surface_.vertices) EXPECT_NEAR(vertex.norm() / radius_, 1, 1e-12);
}

TEST_P(CellMesher, EdgesFollowTheCircles) {
  const std::vector<int> tip = onCircle(surface_, offset_, kTipRadius, +1);
  EXPECT_GE(tip.size(), 8u);
  EXPECT_LE(tip.size(), 14u);  // of the wanted size they are 8; none is half as long
  EXPECT_TRUE(isClosedPolygon(surface_, tip));
  const std::vector<int> mouth = onCircle(surface_, {0, 0}, kContactRadius, -1);
  EXPECT_GE(mouth.size(), 8u);
  EXPECT_TRUE(isClosedPolygon(surface_, mouth));
}

TEST_P(CellMesher, PunctureZoneIsDenser) {
  const CellMeshConfig::Refinement& zone = config_.refinements.front();
  const Eigen::Vector3d entry = pointOnSphere(offset_, +1, radius_);
  double inside = 0, outside = 0;
  int count_inside = 0, count_outside = 0;
  for (size_t t = 0; t < mesh_.tetrahedra.size(); ++t) {
    const std::array<int, 4>& c = mesh_.tetrahedra[t];
    const Eigen::Vector3d centre =
        (mesh_.vertices[c[0]] + mesh_.vertices[c[1]] + mesh_.vertices[c[2]] + mesh_.vertices[c[3]]) / 4;
    const double edge = std::cbrt(tetrahedronVolume(mesh_, static_cast<int>(t)) * 6 * std::sqrt(2));
    const double from_entry = (centre - entry).norm();
    if (from_entry < zone.radius) inside += edge, ++count_inside;
    if (from_entry > 2 * radius_ - zone.radius) outside += edge, ++count_outside;
  }
  ASSERT_GT(count_inside, 100);
  ASSERT_GT(count_outside, 10);
  inside /= count_inside;
  outside /= count_outside;
  EXPECT_NEAR(inside / zone.size, 1, 0.3);
  EXPECT_GT(outside / inside, 0.5 * config_.size / zone.size);
}

INSTANTIATE_TEST_SUITE_P(Offsets, CellMesher,
                         testing::Values(Eigen::Vector2d(0, 0), Eigen::Vector2d(4e-6, -3e-6),
                                         Eigen::Vector2d(-15e-6, 10e-6)));

TEST(CellMesherCircle, ElementsAlongItAreSmallAndGrowAway) {
  CellMeshConfig config = needleCell({12e-6, 0});
  const double edge = kTipRadius / 8;
  config.growth = 0.5;
  config.refinements = {{CellMeshConfig::Shape::kCircle, {12e-6, 0}, kTipRadius, +1, edge}};
  const TetMesh mesh = makeCellMesh(config);
  const SurfaceMesh surface = extractSurface(mesh);
  const std::vector<int> tip = onCircle(surface, {12e-6, 0}, kTipRadius, +1);
  const double length = 2 * M_PI * kTipRadius * (1 + 1 / std::cos(std::asin(12. / 28))) / 2;  // near an ellipse's
  EXPECT_NEAR(tip.size() / (length / edge), 1, 0.08);
  EXPECT_TRUE(isClosedPolygon(surface, tip));
  EXPECT_LT(mesh.tetrahedra.size(), 10000u) << "a tenth of a micrometre all over the cell would be millions";
}

struct Extreme {
  double diameter, size, tip_radius, offset;  // m
};

class CellMesherExtremes : public testing::TestWithParam<Extreme> {};

TEST_P(CellMesherExtremes, AreMeshed) {
  const auto [diameter, size, tip, offset] = GetParam();
  CellMeshConfig config;
  config.radii = {diameter / 2};
  config.size = size;
  config.refinements = {{CellMeshConfig::Shape::kBall, {offset, 0}, 2 * tip, +1, tip}};
  config.imprints = {{{offset, 0}, tip, +1}, {{0, 0}, diameter / 6, -1}};
  const TetMesh mesh = makeCellMesh(config);
  const SurfaceMesh surface = extractSurface(mesh);
  EXPECT_GT(worstRadiusRatio(mesh), 0.15);
  EXPECT_TRUE(isClosedPolygon(surface, onCircle(surface, {offset, 0}, tip, +1)));
  for (const Eigen::Vector3d& vertex : surface.vertices) EXPECT_NEAR(vertex.norm() / config.radii[0], 1, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Cells, CellMesherExtremes,
                         testing::Values(Extreme{20e-6, 4e-6, 1e-6, 0}, Extreme{56e-6, 12e-6, 0.5e-6, 3e-6},
                                         Extreme{56e-6, 12e-6, 3e-6, 20e-6}, Extreme{56e-6, 28e-6, 3e-6, -20e-6},
                                         Extreme{1.2e-3, 0.2e-3, 10e-6, 0.1e-3}));

/// Mean of the elements' height over their width, from the second moments of their corners.
double heightOverWidth(const TetMesh& mesh) {
  double sum = 0;
  for (const auto& corners : mesh.tetrahedra) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
    for (int v : corners) middle += mesh.vertices[v] / 4;
    for (int v : corners) squares += (mesh.vertices[v] - middle).cwiseAbs2();
    sum += std::log(squares.z() / squares.head<2>().mean()) / 2;
  }
  return std::exp(sum / static_cast<double>(mesh.tetrahedra.size()));
}

TEST(CellMesherStretch, ElementsAreAsMuchHigherAndStillMakeTheCell) {
  CellMeshConfig config = needleCell({0, 0});
  const TetMesh plain = makeCellMesh(config);
  for (const double stretch : {1.5, 2.5}) {
    config.stretch = stretch;
    const TetMesh mesh = makeCellMesh(config);
    EXPECT_NEAR(heightOverWidth(mesh) / heightOverWidth(plain), stretch, 0.2 * stretch);
    EXPECT_NEAR(static_cast<double>(mesh.tetrahedra.size()) / static_cast<double>(plain.tetrahedra.size()), 1.2, 0.4);
    EXPECT_GT(worstRadiusRatio(mesh), 0.1);
    const SurfaceMesh surface = extractSurface(mesh);
    for (const Eigen::Vector3d& vertex : surface.vertices) EXPECT_NEAR(vertex.norm() / config.radii[0], 1, 1e-12);
    EXPECT_TRUE(isClosedPolygon(surface, onCircle(surface, {0, 0}, kTipRadius, +1)));
    EXPECT_TRUE(isClosedPolygon(surface, onCircle(surface, {0, 0}, kContactRadius, -1)));
  }
}

TEST(CellMesherPlain, NeedsNeitherRefinementsNorCircles) {
  CellMeshConfig config;
  config.radii = {28e-6};
  const TetMesh mesh = makeCellMesh(config);
  EXPECT_GT(worstRadiusRatio(mesh), 0.15);
  EXPECT_NEAR(meshVolume(mesh) / (4 * M_PI * std::pow(28e-6, 3) / 3), 0.95, 0.02);
}

TEST(CellMesherDeterminism, SameConfigurationSameMesh) {
  CellMeshConfig config = needleCell({1e-6, 0});
  config.radii = {28e-6, 20e-6};
  config.refinements.clear();
  const TetMesh one = makeCellMesh(config), two = makeCellMesh(config);
  EXPECT_EQ(one.vertices, two.vertices);
  EXPECT_EQ(one.tetrahedra, two.tetrahedra);
  EXPECT_EQ(one.layers, two.layers);
}

}  // namespace
}  // namespace microinjection
