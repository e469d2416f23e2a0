#include "operation/display/layer_border.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace microinjection {
namespace {

/// An octahedron of 10 um at rest, pressed to two thirds along z.
CellSurface pressed() {
  const double r = 10e-6;
  CellSurface surface;
  surface.at_rest = {{r, 0, 0}, {0, r, 0}, {-r, 0, 0}, {0, -r, 0}, {0, 0, r}, {0, 0, -r}};
  surface.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}};
  for (const Eigen::Vector3d& vertex : surface.at_rest)
    surface.vertices.emplace_back(vertex.x(), vertex.y(), vertex.z() / 1.5);
  surface.displacement.assign(6, 0);
  return surface;
}

TEST(LayerBorder, BelowALayerItFollowsTheColumns) {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<Eigen::Vector3d> columns(6, Eigen::Vector3d::Constant(unknown));
  columns[4] = {0, 0, 0.5};  // compressed to half its thickness
  const LayerBorder border = borderBelow(pressed(), columns, 2e-6);
  EXPECT_TRUE(border.estimated);
  EXPECT_TRUE(border.drawable());
  EXPECT_NEAR((border.vertices[4] - Eigen::Vector3d(0, 0, 10e-6 / 1.5 - 1e-6)).norm(), 0, 1e-12);
  EXPECT_NEAR((border.vertices[0] - Eigen::Vector3d(8e-6, 0, 0)).norm(), 0, 1e-12) << "as thick as at rest";
}

TEST(LayerBorder, AtRestIsASmallerCell) {
  const Eigen::Vector3d centre(0, 0, 1e-6);
  const LayerBorder border = borderAtRest(pressed(), 2, 0.3, centre);
  EXPECT_EQ(border.layer, 2);
  EXPECT_NEAR((border.vertices[4] - (centre + Eigen::Vector3d(0, 0, 0.3 * 9e-6))).norm(), 0, 1e-12);
}

TEST(LayerBorder, WhatDoesNotFitIsNotDrawn) {
  LayerBorder border = borderAtRest(pressed(), 1, 0.5, Eigen::Vector3d::Zero());
  border.triangles[0][1] = 6;
  EXPECT_FALSE(border.drawable());
  border.triangles[0][1] = 1;
  border.vertices[2].x() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(border.drawable());
  EXPECT_FALSE(LayerBorder().drawable());
}

}  // namespace
}  // namespace microinjection
