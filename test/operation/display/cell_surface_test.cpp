#include "operation/display/cell_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "operation/display/colour_map.h"
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

TriangleSoup coloured(double range) {
  const CellSurface surface = octahedron();
  return colouredSurface(surface, surface.displacement, {SurfaceQuantity::kDisplacement, range});
}

TEST(CellSurface, NormalsPointOutwardsAtTheScaleOfMicrometres) {
  const CellSurface surface = octahedron();
  const auto normals = vertexNormals(surface);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    EXPECT_NEAR((normals[i] - surface.vertices[i].normalized()).norm(), 0, 1e-9) << "vertex " << i;
  }
}

TEST(CellSurface, IsDrawnTenThousandTimesAndFacesOutwards) {
  const TriangleSoup soup = coloured(4e-6);
  EXPECT_TRUE(isClosed(soup));
  EXPECT_NEAR(signedVolume(soup), 4.0 / 3 * 0.1 * 0.1 * 0.1, 1e-12);
}

TEST(CellSurface, ColourIsThatOfTheVertexsDisplacement) {
  const TriangleSoup soup = coloured(8e-6);
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

TEST(CellSurface, FindsItsPoints) {
  const CellSurface surface = octahedron();
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

TEST(CellSurface, AtRestHasTheSameVertices) {
  CellSurface surface = octahedron();
  surface.at_rest = surface.vertices;
  EXPECT_EQ(surface.defect(), "");
  surface.at_rest.pop_back();
  EXPECT_NE(surface.defect().find("rest_vertices"), std::string::npos);
  surface.at_rest.emplace_back(0, std::numeric_limits<double>::infinity(), 0);
  EXPECT_EQ(surface.defect(), "surface at rest is not finite");
}

TEST(SurfaceQuantity, IsFoundByItsName) {
  for (const std::string& name : surfaceQuantities()) {
    ASSERT_TRUE(surfaceQuantity(name));
    EXPECT_EQ(surfaceQuantities()[static_cast<std::size_t>(*surfaceQuantity(name))], name);
  }
  EXPECT_FALSE(surfaceQuantity("colour"));
}

TEST(SurfaceQuantity, PressureHasASignAndWhatIsNotKnownIsGrey) {
  const ColourScale pressure{SurfaceQuantity::kPressure, 2e3};
  EXPECT_EQ(pressure.low(), -2e3);
  EXPECT_EQ(pressure.figure(-2e3), "-2");
  const Colour tension = pressure.colour(-2e3), none = pressure.colour(0), compression = pressure.colour(2e3);
  EXPECT_GT(tension.b, 2 * tension.r);
  EXPECT_GT(compression.r, 2 * compression.b);
  EXPECT_EQ(none.r, none.b);
  const ColourScale stress{SurfaceQuantity::kVonMisesStress, 2e3};
  EXPECT_EQ(stress.low(), 0);
  EXPECT_EQ(stress.colour(1e3).g, colourOfFraction(0.5).g);
  const Colour grey = stress.colour(std::numeric_limits<double>::quiet_NaN());
  EXPECT_NEAR(grey.r, grey.b, 0.05);
}

TEST(SurfaceQuantity, ScaleEndsAtAReadableFigure) {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  EXPECT_DOUBLE_EQ(scaleEnd(SurfaceQuantity::kPressure, {100, -1900, unknown}), 2000);
  EXPECT_DOUBLE_EQ(scaleEnd(SurfaceQuantity::kPressure, {unknown}), 10);
  EXPECT_DOUBLE_EQ(scaleEnd(SurfaceQuantity::kDisplacement, {}), 1e-6);
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
