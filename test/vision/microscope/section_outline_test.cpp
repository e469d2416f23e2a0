#include "vision/microscope/section_outline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"

namespace microinjection {
namespace {

struct Surface {
  std::vector<Eigen::Vector3d> nodes;
  std::vector<std::array<int, 3>> triangles;
};

/// A sphere of rings about z; `kept`: share of the turn that is there.
Surface sphere(const Eigen::Vector3d& centre, double radius, int rings = 40, double kept = 1) {
  Surface surface;
  const int sectors = 2 * rings, last = static_cast<int>(kept * sectors);
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const double polar = M_PI * i / rings, turn = 2 * M_PI * j / sectors;
      surface.nodes.emplace_back(centre + radius * Eigen::Vector3d(std::sin(polar) * std::cos(turn),
                                                                   std::sin(polar) * std::sin(turn), std::cos(polar)));
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < last; ++j) {
      const int a = i * sectors + j, b = i * sectors + (j + 1) % sectors;
      surface.triangles.push_back({a, a + sectors, b});
      surface.triangles.push_back({b, a + sectors, b + sectors});
    }
  }
  // The rings at the poles are single points: their nodes are one.
  for (auto& triangle : surface.triangles)
    for (int& node : triangle) node = node < sectors ? 0 : node >= rings * sectors ? rings * sectors : node;
  surface.triangles.erase(std::remove_if(surface.triangles.begin(), surface.triangles.end(),
                                         [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[0] == t[2]; }),
                          surface.triangles.end());
  return surface;
}

TEST(SectionOutline, OfASphereIsACircle) {
  const Surface surface = sphere({10e-6, 5e-6, -3e-6}, 50e-6);
  for (const double y : {5e-6, -20e-6}) {
    const CellOutline outline = sectionOutline(surface.nodes, surface.triangles, y);
    ASSERT_GT(outline.size(), 60u) << y;
    const double radius = std::sqrt(50e-6 * 50e-6 - (y - 5e-6) * (y - 5e-6));
    for (const auto& corner : outline)
      EXPECT_NEAR((corner - Eigen::Vector2d(10e-6, -3e-6)).norm(), radius, 0.2e-6) << y;
    // Neighbours are near each other: the corners are in order.
    for (std::size_t i = 0; i < outline.size(); ++i)
      EXPECT_LT((outline[i] - outline[(i + 1) % outline.size()]).norm(), 5e-6) << y << " " << i;
  }
}

TEST(SectionOutline, IsTheLargestOfSeveral) {
  Surface surface = sphere({0, 0, 0}, 10e-6);
  const Surface large = sphere({100e-6, 0, 0}, 30e-6);
  const int offset = static_cast<int>(surface.nodes.size());
  surface.nodes.insert(surface.nodes.end(), large.nodes.begin(), large.nodes.end());
  for (const auto& t : large.triangles) surface.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  const CellOutline outline = sectionOutline(surface.nodes, surface.triangles, 1e-6);
  ASSERT_FALSE(outline.empty());
  for (const auto& corner : outline) EXPECT_GT(corner.x(), 60e-6);
}

TEST(SectionOutline, IsEmptyBesideAnOpenSurface) {
  const Surface whole = sphere({0, 0, 0}, 50e-6), open = sphere({0, 0, 0}, 50e-6, 40, 0.7);
  EXPECT_TRUE(sectionOutline(whole.nodes, whole.triangles, 51e-6).empty());
  EXPECT_TRUE(sectionOutline(open.nodes, open.triangles, -1e-6).empty());
  EXPECT_TRUE(sectionOutline({}, {}, 0).empty());
  EXPECT_THROW(sectionOutline(whole.nodes, {{0, 1, 100000}}, 0), ConfigError);
}

TEST(InsetOutline, OfACircleIsASmallerCircleInEitherSense) {
  CellOutline outline = circleOutline({5e-6, 0}, 50e-6);
  for (int sense = 0; sense < 2; ++sense) {
    for (const auto& corner : insetOutline(outline, 8e-6))
      EXPECT_NEAR((corner - Eigen::Vector2d(5e-6, 0)).norm(), 42e-6, 1e-9);
    std::reverse(outline.begin(), outline.end());
  }
}

TEST(InsetOutline, SidesOfASquareMoveByTheDistance) {
  const CellOutline inset = insetOutline({{0, 0}, {10, 0}, {10, 10}, {0, 10}}, 2);
  EXPECT_NEAR((inset[0] - Eigen::Vector2d(2, 2)).norm(), 0, 1e-12);
  EXPECT_NEAR((inset[2] - Eigen::Vector2d(8, 8)).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace microinjection
