#include "cell/contact/ray_cast.h"

#include <gtest/gtest.h>

#include <random>

#include "cell/mesh/cell_mesher.h"
#include "cell/mesh/shapes.h"

namespace microinjection {
namespace {

using Eigen::Vector3d;

SurfaceMesh cubeSurface() { return extractSurface(unitCube(2)); }

SurfaceMesh cellSurface() { return extractSurface(makeCellMesh({})); }

TEST(CastRay, HitsTheNearestFace) {
  const SurfaceMesh cube = cubeSurface();
  const auto hit = castRay(cube, {0.3, 0.6, 5}, {0, 0, -2});
  ASSERT_TRUE(hit);
  EXPECT_NEAR((hit->point - Vector3d(0.3, 0.6, 1)).norm(), 0, 1e-14);
  EXPECT_EQ(hit->normal, Vector3d(0, 0, 1));
  EXPECT_NEAR(hit->distance, 4, 1e-14);
}

TEST(CastRay, FromInsideHitsTheWayOut) {
  const auto hit = castRay(cubeSurface(), {0.3, 0.6, 0.5}, {0, 0, -1});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->normal, Vector3d(0, 0, -1));
  EXPECT_NEAR(hit->distance, 0.5, 1e-14);
}

TEST(CastRay, Misses) {
  const SurfaceMesh cube = cubeSurface();
  EXPECT_FALSE(castRay(cube, {1.001, 0.5, 5}, {0, 0, -1}));  // beside
  EXPECT_FALSE(castRay(cube, {0.5, 0.5, 5}, {0, 0, 1}));     // behind
  EXPECT_FALSE(castRay(cube, {5, 0.5, 1.001}, {-1, 0, 0}));  // above
  EXPECT_FALSE(castRayFrom(cube, 0, {1.001, 0.5, 5}, {0, 0, -1}));
  EXPECT_FALSE(castRayFrom(cube, 0, {0.5, 0.5, 5}, {0, 0, 1}));
}

TEST(CastRay, EdgesAndCornersHaveNoGaps) {
  const SurfaceMesh cube = cubeSurface();
  for (double x = 0.125; x < 1; x += 0.125) {
    for (double y = 0.125; y < 1; y += 0.125) {  // every second one on an edge, x = y on diagonals, (0.5, 0.5) a corner
      const auto hit = castRay(cube, {x, y, 3}, {0, 0, -1});
      ASSERT_TRUE(hit) << x << ' ' << y;
      EXPECT_NEAR(hit->point.z(), 1, 1e-14);
      const auto local = castRayFrom(cube, hit->triangle, {x, y, 3}, {0, 0, -1});
      ASSERT_TRUE(local);
      EXPECT_NEAR(local->point.z(), 1, 1e-14);
    }
  }
}

TEST(CastRay, GrazingRaysInTheFacesPlaneDoNotHitThatFace) {
  const SurfaceMesh cube = cubeSurface();
  const auto hit = castRay(cube, {-1, 0.3, 0.9999999}, {1, 0, 0});  // just below the top: the side
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->normal, Vector3d(-1, 0, 0));
  EXPECT_FALSE(castRay(cube, {-1, 0.3, 1.0000001}, {1, 0, 0}));
}

TEST(CastRayFrom, IsTheSearchOfAllTriangles) {
  const SurfaceMesh cell = cellSurface();
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vector3d(normal(random), normal(random), normal(random)); };
  std::uniform_int_distribution<int> triangle(0, static_cast<int>(cell.triangles.size()) - 1);
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d origin = 60e-6 * vector().normalized();
    const Vector3d direction = 20e-6 * vector() - origin;  // past the cell now and then
    const auto all = castRay(cell, origin, direction), local = castRayFrom(cell, triangle(random), origin, direction);
    ASSERT_EQ(all.has_value(), local.has_value());
    if (!all) continue;
    ++hits;
    EXPECT_EQ(all->triangle, local->triangle);
    EXPECT_EQ(all->point, local->point);
    EXPECT_LT(all->normal.dot(direction), 0);
  }
  EXPECT_GT(hits, 1500);
  EXPECT_LT(hits, 2990);
}

TEST(CastRayFrom, BadStartsAreNoHarm) {
  const SurfaceMesh cube = cubeSurface();
  for (const int start : {-1, 1000000, 0, 47}) {
    const auto hit = castRayFrom(cube, start, {0.3, 0.6, 5}, {0, 0, -1});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->point.z(), 1, 1e-14);
  }
}

}  // namespace
}  // namespace microinjection
