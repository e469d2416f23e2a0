#include "operation/display/quadratic_facets.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "operation/display/cell_surface.h"

namespace microinjection {
namespace {

/// A sphere of 10 um whose triangles are split into four, again and again; the last split makes facets of second order.
struct Sphere {
  static constexpr double kRadius = 10e-6;  // m
  CellSurface surface;
  Eigen::Array3d axes = Eigen::Array3d::Ones();  // of the ellipsoid it is stretched to
  std::map<std::pair<int, int>, int> middles;

  explicit Sphere(int splits) {
    const double a = 0.3;  // turned, so that no symmetry helps
    const Eigen::AngleAxisd turned(a, Eigen::Vector3d(1, 2, 3).normalized());
    for (const Eigen::Vector3d& corner :
         {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(0, -1, 0),
          Eigen::Vector3d(0.1, 0.2, 1), Eigen::Vector3d(-0.2, 0.1, -1)})
      surface.vertices.emplace_back(kRadius * (turned * corner).normalized());
    surface.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}};
    for (int i = 0; i < splits; ++i) split();
  }

  int middle(int from, int to) {
    const auto [at, is_new] = middles.try_emplace(std::minmax(from, to), static_cast<int>(surface.vertices.size()));
    if (is_new) surface.vertices.emplace_back(kRadius * (surface.vertices[from] + surface.vertices[to]).normalized());
    return at->second;
  }

  void split() {
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : std::vector<std::array<int, 3>>(surface.triangles)) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    surface.triangles = finer;
  }

  Sphere& stretch(double x, double y, double z) {
    axes = {x, y, z};
    for (Eigen::Vector3d& vertex : surface.vertices) vertex.array() *= axes;
    return *this;
  }

  /// Its triangles in another order, which hides the facets.
  Sphere& hideFacets() {
    std::rotate(surface.triangles.begin(), surface.triangles.begin() + 1, surface.triangles.end());
    EXPECT_TRUE(quadraticFacets(surface.triangles).empty());
    return *this;
  }

  /// rad, the largest of all vertices.
  double error() const {
    const auto normals = vertexNormals(surface);
    double largest = 0;
    for (std::size_t i = 0; i < normals.size(); ++i)
      largest =
          std::max(largest, (normals[i] - (surface.vertices[i].array() / axes.square()).matrix().normalized()).norm());
    return largest;
  }
};

TEST(QuadraticFacets, NormalsOfASphereConvergeWithTheCubeOfTheFacetsSize) {
  double before = Sphere(2).error();
  for (const int splits : {3, 4, 5}) {
    const double now = Sphere(splits).error();
    RecordProperty("error_of_splits_" + std::to_string(splits), std::to_string(now));
    EXPECT_GT(std::log2(before / now), 2.8) << splits << ": " << before << " " << now;
    before = now;
  }
  EXPECT_LT(before, 2e-4);
}

TEST(QuadraticFacets, WithoutThemTheNormalsOfASphereAreExact) {
  for (const int splits : {1, 3}) EXPECT_LT(Sphere(splits).hideFacets().error(), 1e-12) << splits;
}

TEST(QuadraticFacets, NormalsOfAnEllipsoidConvergeFasterThanWithoutThem) {
  double flat_before = 0, before = 0;
  for (const int splits : {3, 4, 5}) {
    const double now = Sphere(splits).stretch(1, 1.2, 0.8).error();
    const double flat = Sphere(splits).stretch(1, 1.2, 0.8).hideFacets().error();
    EXPECT_LT(now, 0.7 * flat) << splits;
    if (splits > 3) {
      EXPECT_GT(std::log2(before / now), 2.8) << splits;
      EXPECT_GT(std::log2(flat_before / flat), 1) << splits;
    }
    before = now;
    flat_before = flat;
  }
}

TEST(QuadraticFacets, AreFoundInFoursOfTriangles) {
  const Sphere sphere(3);
  const auto facets = quadraticFacets(sphere.surface.triangles);
  ASSERT_EQ(4 * facets.size(), sphere.surface.triangles.size());
  for (const QuadraticFacet& facet : facets) {
    const auto at = [&](int i) { return sphere.surface.vertices[facet[i]]; };
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d middle = (at(i) + at((i + 1) % 3)).normalized();
      EXPECT_NEAR((at(3 + i).normalized() - middle).norm(), 0, 1e-12);
    }
  }
  EXPECT_TRUE(quadraticFacets({{0, 1, 2}, {2, 1, 3}, {0, 2, 3}}).empty());
  EXPECT_TRUE(quadraticFacets({{0, 1, 2}, {2, 1, 3}, {0, 2, 3}, {0, 3, 1}}).empty());
}

}  // namespace
}  // namespace microinjection
