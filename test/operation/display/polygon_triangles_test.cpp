#include "operation/display/polygon_triangles.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

/// A closed curve that is at `radius(angle)`.
template <typename Radius>
Polygon around(int corners, const Radius& radius) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * M_PI * i / corners;
    polygon.emplace_back(radius(angle) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

double areaOf(const Polygon& polygon) {
  double area = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    area += turn({0, 0}, polygon[i], polygon[(i + 1) % polygon.size()]) / 2;
  return area;
}

/// Triangles that are all counter-clockwise and have the polygon's area cover its inside once.
void checkCovers(const Polygon& polygon) {
  const auto triangles = polygonTriangles(polygon);
  ASSERT_EQ(triangles.size(), polygon.size() - 2);
  double area = 0;
  for (const auto& [a, b, c] : triangles) {
    const double twice = turn(polygon[a], polygon[b], polygon[c]);
    ASSERT_GE(twice, -1e-15);
    area += twice / 2;
  }
  EXPECT_NEAR(area, areaOf(polygon), 1e-9 * areaOf(polygon));
}

/// A cell with a dent that is deeper than its centre, so that no point sees all of the curve.
TEST(PolygonTriangles, CoverADeepDentOf5000Corners) {
  Polygon dented = around(4000, [](double) { return 1.0; });
  dented.erase(dented.begin() + 990, dented.begin() + 1010);
  Polygon dent;
  for (int i = 1; i < 510; ++i)
    dent.emplace_back(0.9 * dented[989].x() * (1 - i / 510.0), 1 - 1.6 * std::sin(M_PI / 2 * i / 510));
  for (int i = 510; i > 0; --i)
    dent.emplace_back(0.9 * dented[990].x() * (1 - i / 510.0), 1 - 1.6 * std::sin(M_PI / 2 * i / 510));
  dented.insert(dented.begin() + 990, dent.begin(), dent.end());
  ASSERT_GT(dented.size(), 4990u);
  checkCovers(dented);
}

/// Every second corner is a reflex one.
TEST(PolygonTriangles, CoverAStarOf5000Corners) {
  int corner = 0;
  checkCovers(around(5000, [&corner](double) { return corner++ % 2 == 0 ? 1.0 : 0.8; }));
}

TEST(PolygonTriangles, CoverASpiral) {
  constexpr int kCorners = 2500;
  Polygon spiral;
  const auto at = [](double turns, double radius) {
    return Eigen::Vector2d(radius * Eigen::Vector2d(std::cos(2 * M_PI * turns), std::sin(2 * M_PI * turns)));
  };
  for (int i = 0; i < kCorners; ++i) spiral.push_back(at(3.0 * i / kCorners, 1 + 3.0 * i / kCorners));
  for (int i = kCorners; i > 0; --i) spiral.push_back(at(3.0 * i / kCorners, 0.5 + 3.0 * i / kCorners));
  if (areaOf(spiral) < 0) spiral = Polygon(spiral.rbegin(), spiral.rend());
  checkCovers(spiral);
}

TEST(PolygonTriangles, OfFewOrCoincidentCornersEnd) {
  EXPECT_TRUE(polygonTriangles({}).empty());
  EXPECT_TRUE(polygonTriangles({{0, 0}, {1, 0}}).empty());
  EXPECT_EQ(polygonTriangles({{0, 0}, {1, 0}, {0, 1}}).size(), 1u);
  EXPECT_EQ(polygonTriangles(Polygon(1000, {1, 1})).size(), 998u);
  // An eight crosses itself.
  EXPECT_EQ(polygonTriangles({{0, 0}, {2, 2}, {2, 0}, {0, 2}}).size(), 2u);
}

}  // namespace
}  // namespace microinjection
