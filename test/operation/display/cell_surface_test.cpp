#include "operation/display/cell_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "operation/display/shading.h"
#include "soup_measures.h"

namespace microinjection {
namespace {

/// An octahedron of 10 um, its upper vertex displaced by 4 um.
CellSurface octahedron() {
  const double r = 10e-6;
  CellSurface surface;
  surface.vertices = {{r, 0, 0}, {0, r, 0}, {-r, 0, 0}, {0, -r, 0}, {0, 0, r}, {0, 0, -r}};
  surface.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}};
  surface.displacement = {0, 0, 0, 0, 4e-6, 0};
  surface.contact_vertices = {4};
  surface.held_vertices = {5};
  return surface;
}

TEST(CellSurface, NormalsPointOutwardsAtTheScaleOfMicrometres) {
  const CellSurface surface = octahedron();
  const auto normals = vertexNormals(surface);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    EXPECT_NEAR((normals[i] - surface.vertices[i].normalized()).norm(), 0, 1e-9) << "vertex " << i;
  }
}

TEST(CellSurface, IsDrawnTenThousandTimesAndFacesOutwards) {
  const TriangleSoup soup = colouredSurface(octahedron(), 4e-6);
  EXPECT_TRUE(isClosed(soup));
  EXPECT_NEAR(signedVolume(soup), 4.0 / 3 * 0.1 * 0.1 * 0.1, 1e-12);
}

TEST(CellSurface, ColourIsThatOfTheVertexsDisplacement) {
  const TriangleSoup soup = colouredSurface(octahedron(), 8e-6);
  ASSERT_EQ(soup.colours.size(), soup.points.size());
  const Colour top = shaded(colourOfFraction(0.5), lampLight({0, 0, 1}));
  const Colour right = shaded(colourOfFraction(0), lampLight({1, 0, 0}));
  EXPECT_NEAR(soup.colours[2].g, top.g, 1e-6);
  EXPECT_NEAR(soup.colours[0].g, right.g, 1e-6);
}

TEST(CellSurface, HasEachEdgeOnceAndLifted) {
  const LineList lines = edges(octahedron(), 0.01);
  ASSERT_EQ(lines.size(), 2U * 12);
  for (const Eigen::Vector3d& point : lines) EXPECT_NEAR(point.norm(), 0.1 + 0.01, 1e-9);
}

TEST(CellSurface, FindsItsPointsAndItsLargestDisplacement) {
  const CellSurface surface = octahedron();
  EXPECT_DOUBLE_EQ(surface.largestDisplacement(), 4e-6);
  const auto points = pointsAt(surface, surface.contact_vertices);
  ASSERT_EQ(points.size(), 1U);
  EXPECT_NEAR((points[0] - Eigen::Vector3d(0, 0, 0.1)).norm(), 0, 1e-12);
}

TEST(CellSurface, SaysWhatCannotBeDrawn) {
  EXPECT_EQ(octahedron().defect(), "");
  EXPECT_NE(CellSurface().defect(), "");
  CellSurface surface = octahedron();
  surface.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(surface.defect(), "surface is not finite");
  surface = octahedron();
  surface.displacement[0] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(surface.defect(), "surface is not finite");
  surface = octahedron();
  surface.displacement.pop_back();
  EXPECT_NE(surface.defect().find("displacement"), std::string::npos);
  surface = octahedron();
  surface.triangles[0][1] = 6;
  EXPECT_NE(surface.defect().find("triangles"), std::string::npos);
  surface = octahedron();
  surface.contact_vertices = {-1};
  EXPECT_NE(surface.defect().find("contact_vertices"), std::string::npos);
  surface = octahedron();
  surface.held_vertices = {6};
  EXPECT_NE(surface.defect().find("held_vertices"), std::string::npos);
}

TEST(Shading, IsBrightestTowardsTheLampAndNeverDark) {
  const double front = lampLight(Eigen::Vector3d(-0.4, -0.7, 0.6).normalized());
  const double back = lampLight(Eigen::Vector3d(0.4, 0.7, -0.6).normalized());
  EXPECT_GT(front, 1);
  EXPECT_GT(front, 1.5 * back);
  EXPECT_GT(back, 0.5);
  EXPECT_FLOAT_EQ(shaded({0.5f, 0.25f, 0.9f, 0.3f}, 2).g, 0.5f);
  EXPECT_FLOAT_EQ(shaded({0.5f, 0.25f, 0.9f, 0.3f}, 2).b, 1.0f);
  EXPECT_FLOAT_EQ(shaded({0.5f, 0.25f, 0.9f, 0.3f}, 2).a, 0.3f);
}

}  // namespace
}  // namespace microinjection
