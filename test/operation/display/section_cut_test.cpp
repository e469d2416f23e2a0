#include "operation/display/section_cut.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "soup_measures.h"

namespace microinjection {
namespace {

struct Ball {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;

  TriangleSoup soup(double blue) const {
    TriangleSoup result;
    for (const auto& [a, b, c] : triangles) result.add(vertices[a], vertices[b], vertices[c]);
    for (std::size_t i = 0; i < result.points.size(); ++i)
      result.colours.push_back({static_cast<float>(result.points[i].y()), 0, static_cast<float>(blue), 1});
    return result;
  }
};

Ball ball(double radius, const Eigen::Vector3d& centre = Eigen::Vector3d::Zero()) {
  constexpr int kRings = 40, kSectors = 80;
  Ball result;
  result.vertices.emplace_back(centre + Eigen::Vector3d(0, 0, radius));
  for (int ring = 1; ring < kRings; ++ring) {
    for (int sector = 0; sector < kSectors; ++sector) {
      const double polar = M_PI * ring / kRings, around = 2 * M_PI * sector / kSectors;
      result.vertices.emplace_back(centre + radius * Eigen::Vector3d(std::sin(polar) * std::cos(around),
                                                                     std::sin(polar) * std::sin(around),
                                                                     std::cos(polar)));
    }
  }
  result.vertices.emplace_back(centre - Eigen::Vector3d(0, 0, radius));
  const int last = static_cast<int>(result.vertices.size()) - 1;
  for (int sector = 0; sector < kSectors; ++sector) {
    const int beside = (sector + 1) % kSectors;
    result.triangles.push_back({0, 1 + sector, 1 + beside});
    for (int ring = 0; ring + 2 < kRings; ++ring) {
      const int a = 1 + ring * kSectors, b = a + kSectors;
      result.triangles.push_back({a + sector, b + sector, a + beside});
      result.triangles.push_back({a + beside, b + sector, b + beside});
    }
    const int bottom = 1 + (kRings - 2) * kSectors;
    result.triangles.push_back({last, bottom + beside, bottom + sector});
  }
  return result;
}

void append(const TriangleSoup& more, TriangleSoup& soup) {
  soup.points.insert(soup.points.end(), more.points.begin(), more.points.end());
}

/// Also of planes that pass through vertices, as y = 0 does.
TEST(SectionCut, WhatRemainsIsClosedByItsCap) {
  const Ball body = ball(1);
  for (const double y : {0.0, 0.3, -0.45}) {
    for (const Eigen::Vector3d& axis : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.3, 0.2, 1)}) {
      const CutPlane plane = CutPlane::along({0.1, y, 0}, axis.normalized());
      TriangleSoup rest = remains(body.soup(0), plane);
      append(inside(outline(body.vertices, body.triangles, plane), plane, {}), rest);
      const double height = 1 - plane.height(Eigen::Vector3d::Zero());  // of what remains
      EXPECT_TRUE(isClosed(rest)) << y;
      const double expected = M_PI * height * height * (3 - height) / 3;
      EXPECT_NEAR(signedVolume(rest), expected, 0.01 * expected) << y;
    }
  }
}

TEST(SectionCut, PlaneContainsTheAxisAndFacesTheViewer) {
  const Eigen::Vector3d axis = Eigen::Vector3d(0.3, 0.2, 1).normalized();
  const CutPlane plane = CutPlane::along({1, 2, 3}, axis);
  EXPECT_NEAR(plane.normal.dot(axis), 0, 1e-12);
  EXPECT_NEAR(plane.normal.norm(), 1, 1e-12);
  EXPECT_LT(plane.normal.y(), -0.9);
  EXPECT_NEAR(CutPlane::along({0, 0, 0}, Eigen::Vector3d::UnitY()).normal.y(), 0, 1e-12);
}

TEST(SectionCut, ColourAtTheCutIsInterpolated) {
  const CutPlane plane{{0, 0.2, 0}, {0, 1, 0}};
  const TriangleSoup rest = remains(ball(1).soup(0.5), plane);
  for (std::size_t i = 0; i < rest.points.size(); ++i) {
    ASSERT_LE(rest.points[i].y(), 0.2 + 1e-9);
    ASSERT_NEAR(rest.colours[i].r, rest.points[i].y(), 1e-6);
    ASSERT_FLOAT_EQ(rest.colours[i].b, 0.5f);
  }
}

TEST(SectionCut, LinesEndAtThePlane) {
  const CutPlane plane{{0, 0, 0}, {0, 0, 1}};
  const LineList lines = {{0, 0, -1}, {0, 0, 3}, {1, 0, 1}, {1, 0, 2}, {2, 0, -2}, {2, 0, -1}};
  const LineList rest = remains(lines, plane);
  ASSERT_EQ(rest.size(), 4u);
  EXPECT_NEAR(rest[1].norm(), 0, 1e-12);
  EXPECT_EQ(rest[2], Eigen::Vector3d(2, 0, -2));
}

/// A curve with a dent, as under a needle.
TEST(SectionCut, ADentedCurveIsFilledWithoutTheDent) {
  const std::vector<Eigen::Vector3d> curve = {{0, 0, 0}, {4, 0, 0}, {4, 0, 4}, {2, 0, 1}, {0, 0, 4}};
  const CutPlane plane{{0, 0, 0}, {0, -1, 0}};
  const TriangleSoup soup = inside(curve, plane, {1, 0, 0, 1});
  double area = 0;
  for (std::size_t i = 0; i < soup.points.size(); i += 3) {
    area += (soup.points[i + 1] - soup.points[i]).cross(soup.points[i + 2] - soup.points[i]).dot(plane.normal) / 2;
  }
  EXPECT_NEAR(area, 16 - 6, 1e-12);
  EXPECT_EQ(segments(curve).size(), 10u);
}

TEST(SectionCut, OfASurfaceThatThePlaneMissesIsEmpty) {
  const Ball body = ball(1);
  EXPECT_TRUE(outline(body.vertices, body.triangles, {{0, 2, 0}, {0, 1, 0}}).empty());
  EXPECT_TRUE(inside({}, {}, {}).points.empty());
}

}  // namespace
}  // namespace microinjection
