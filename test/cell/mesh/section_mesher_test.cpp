#include "cell/mesh/section_mesher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace microinjection {
namespace {

using Eigen::Vector2d;

constexpr double kSectionRadius = 28e-6;  // m

SectionMeshConfig layeredSection() {
  SectionMeshConfig config;
  config.radii = {kSectionRadius, 24e-6, 8e-6};
  config.refinements = {{3e-6, +1, 0, kSectionRadius / 5000}, {10e-6, -1, 0.2e-6, 0.1e-6}};
  config.vertices = {{3e-6, +1}, {10e-6, -1}, {27e-6, -1}};
  return config;
}

const TriangleMesh& layeredMesh() {
  static const TriangleMesh mesh = makeSectionMesh(layeredSection());
  return mesh;
}

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Volume that one triangle sweeps around the axis, m^3: 2 pi times its area times its centroid's r
/// (Pappus).
double sweptVolume(const TriangleMesh& mesh, int triangle) {
  const std::array<int, 3>& corners = mesh.triangles[triangle];
  const double r = (mesh.vertices[corners[0]] + mesh.vertices[corners[1]] + mesh.vertices[corners[2]]).x() / 3;
  return 2 * M_PI * r * triangleArea(mesh, triangle);
}

/// Smallest angle of one triangle, rad.
double smallestAngle(const TriangleMesh& mesh, int triangle) {
  const std::array<int, 3>& corners = mesh.triangles[triangle];
  double smallest = M_PI;
  for (int i = 0; i < 3; ++i) {
    const Vector2d& at = mesh.vertices[corners[i]];
    const Vector2d to = mesh.vertices[corners[(i + 1) % 3]] - at;
    const Vector2d from = mesh.vertices[corners[(i + 2) % 3]] - at;
    smallest = std::min(smallest, std::atan2(std::abs(cross(to, from)), to.dot(from)));
  }
  return smallest;
}

/// Triangles of each edge, by its vertices in ascending order.
std::map<std::array<int, 2>, std::vector<int>> edgesOf(const TriangleMesh& mesh) {
  std::map<std::array<int, 2>, std::vector<int>> edges;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3]);
      edges[{low, high}].push_back(static_cast<int>(t));
    }
  }
  return edges;
}

TEST(SectionMesher, EveryEdgeIsSharedOrOnTheBoundary) {
  const TriangleMesh& mesh = layeredMesh();
  const std::vector<double> radii = layeredSection().radii;
  std::vector<int> on_arc(radii.size(), 0);
  double axis = 0;
  for (const auto& [edge, triangles] : edgesOf(mesh)) {
    ASSERT_LE(triangles.size(), 2u);
    const Vector2d &a = mesh.vertices[edge[0]], &b = mesh.vertices[edge[1]];
    if (triangles.size() == 1 && a.x() == 0 && b.x() == 0) {
      axis += (a - b).norm();
      continue;
    }
    const int one = mesh.layers[triangles[0]], other = triangles.size() == 1 ? one - 1 : mesh.layers[triangles[1]];
    if (one == other) continue;
    ASSERT_EQ(std::abs(one - other), 1);
    const int inner = std::max(one, other);
    ASSERT_TRUE(triangles.size() == 2 || inner == 0);
    for (int v : edge) ASSERT_NEAR(mesh.vertices[v].norm() / radii[inner], 1, 1e-15);
    ++on_arc[inner];
  }
  EXPECT_NEAR(axis, 2 * kSectionRadius, 1e-18);
  for (int edges : on_arc) EXPECT_GE(edges, 8);
}

TEST(SectionMesher, TrianglesAreCounterClockwiseInTheirLayer) {
  const TriangleMesh& mesh = layeredMesh();
  const std::vector<double> radii = layeredSection().radii;
  ASSERT_EQ(mesh.layers.size(), mesh.triangles.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    Vector2d centroid = Vector2d::Zero();
    for (int v : mesh.triangles[t]) {
      centroid += mesh.vertices[v] / 3;
      EXPECT_GE(mesh.vertices[v].x(), 0);
    }
    const size_t layer = mesh.layers[t];
    EXPECT_GT(triangleArea(mesh, static_cast<int>(t)), 0);
    EXPECT_LT(centroid.norm(), radii[layer]);
    EXPECT_GT(centroid.norm(), layer + 1 < radii.size() ? radii[layer + 1] : 0);
  }
}

TEST(SectionMesher, NamedPointsAreVertices) {
  const TriangleMesh& mesh = layeredMesh();
  const auto isVertex = [&](double r, double z) {
    return std::any_of(mesh.vertices.begin(), mesh.vertices.end(),
                       [&](const Vector2d& v) { return v.x() == r && std::abs(v.y() - z) < 1e-15 * kSectionRadius; });
  };
  EXPECT_TRUE(isVertex(3e-6, std::sqrt(kSectionRadius * kSectionRadius - 9e-12)));
  EXPECT_TRUE(isVertex(10e-6, -std::sqrt(kSectionRadius * kSectionRadius - 100e-12)));
  EXPECT_TRUE(isVertex(27e-6, -std::sqrt(kSectionRadius * kSectionRadius - 729e-12)));
  for (double radius : layeredSection().radii) {
    EXPECT_TRUE(isVertex(0, radius));
    EXPECT_TRUE(isVertex(0, -radius));
  }
}

TEST(SectionMesher, IsFineAndWellShapedAroundARefinement) {
  const TriangleMesh& mesh = layeredMesh();
  const Vector2d edge = pointOnArc(3e-6, +1, kSectionRadius);
  double shortest = 1, smallest = M_PI;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    smallest = std::min(smallest, smallestAngle(mesh, static_cast<int>(t)));
    for (int v : mesh.triangles[t]) {
      const double distance = (mesh.vertices[v] - edge).norm();
      if (distance > 0) shortest = std::min(shortest, distance);
    }
  }
  EXPECT_NEAR(shortest / (kSectionRadius / 5000), 1, 0.5);
  EXPECT_GT(smallest, 15 * M_PI / 180);
  EXPECT_LT(mesh.triangles.size(), 10000u) << "graded, not fine all over";
}

TEST(SectionMesher, SweptVolumesConvergeToTheShells) {
  const auto errors = [](double size) {
    SectionMeshConfig config;
    config.radii = {kSectionRadius, 14e-6};
    config.size = size;
    const TriangleMesh mesh = makeSectionMesh(config);
    double volumes[2] = {0, 0};
    for (size_t t = 0; t < mesh.triangles.size(); ++t) volumes[mesh.layers[t]] += sweptVolume(mesh, t);
    const double ball = 4 * M_PI * std::pow(14e-6, 3) / 3;
    return std::array{1 - volumes[0] / (7 * ball), 1 - volumes[1] / ball};
  };
  const auto coarse = errors(2e-6), fine = errors(1e-6);
  for (int layer : {0, 1}) {
    EXPECT_NEAR(coarse[layer] / fine[layer], 4, 0.6);
    EXPECT_LT(std::abs(fine[layer]), 2e-3);
  }
}

TEST(SectionMesher, ThinLayersAndExtremes) {
  SectionMeshConfig thin;
  thin.radii = {kSectionRadius, kSectionRadius - 0.1e-6};
  SectionMeshConfig coarse;
  coarse.size = 1;
  SectionMeshConfig close;
  close.vertices = {{3e-6, 1}, {3.001e-6, 1}, {0, 1}, {kSectionRadius, 1}};
  SectionMeshConfig large;
  large.radii = {600e-6, 580e-6};
  large.size = 50e-6;
  large.refinements = {{0, 1, 0, 0.1e-6}};
  for (const SectionMeshConfig& config : {thin, coarse, close, large}) {
    const TriangleMesh mesh = makeSectionMesh(config);
    std::vector<int> on_arc(config.radii.size(), 0);
    for (const Vector2d& vertex : mesh.vertices) {
      for (size_t k = 0; k < config.radii.size(); ++k)
        on_arc[k] += std::abs(vertex.norm() / config.radii[k] - 1) < 1e-14;
    }
    for (int vertices : on_arc) EXPECT_GE(vertices, 9);
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      EXPECT_GT(smallestAngle(mesh, static_cast<int>(t)), 15 * M_PI / 180);
    }
  }
}

TEST(SectionMesher, SameConfigurationSameMesh) {
  const TriangleMesh again = makeSectionMesh(layeredSection());
  EXPECT_EQ(again.vertices, layeredMesh().vertices);
  EXPECT_EQ(again.triangles, layeredMesh().triangles);
  EXPECT_EQ(again.layers, layeredMesh().layers);
}

TEST(TriangleMesh, MeasuresOfAKnownTriangle) {
  TriangleMesh mesh;  // a cylinder of radius 2 and height 3, halved along its diagonal: a cone is left
  mesh.vertices = {{0, 0}, {2, 0}, {0, 3}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 1}};
  EXPECT_NEAR(triangleArea(mesh, 0), 3, 1e-15);
  EXPECT_NEAR(triangleArea(mesh, 1), -3, 1e-15);
  EXPECT_NEAR(sweptVolume(mesh, 0), M_PI * 4 * 3 / 3, 1e-14);
  EXPECT_NEAR(smallestAngle(mesh, 0), std::atan2(2, 3), 1e-15);
}

}  // namespace
}  // namespace microinjection
