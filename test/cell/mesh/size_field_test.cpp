#include "cell/mesh/size_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "cell/mesh/needle_cell.h"

namespace microinjection {
namespace {

using Eigen::Vector3d;

TEST(SizeField, GrowsFromABallOutwards) {
  CellMeshConfig config = needleCell();
  config.imprints.clear();
  const SizeField size(config);
  const Vector3d pole(0, 0, 28e-6);
  EXPECT_DOUBLE_EQ(size(pole), 12e-6 / 5);
  EXPECT_DOUBLE_EQ(size(pole - Vector3d(0, 0, 15e-6)), 12e-6 / 5);
  EXPECT_DOUBLE_EQ(size(pole - Vector3d(0, 0, 18e-6)), 12e-6 / 5 + 1e-6);
  EXPECT_DOUBLE_EQ(size(-pole), 12e-6);
}

TEST(SizeField, GrowsFromACircleOnItsSide) {
  CellMeshConfig config;
  config.growth = 0.5;
  config.refinements = {{CellMeshConfig::Shape::kCircle, {0, 0}, 10e-6, -1, 0.5e-6}};
  const SizeField size(config);
  const double z = -std::sqrt(28. * 28 - 100) * 1e-6;
  EXPECT_NEAR(size({6e-6, -8e-6, z}), 0.5e-6, 1e-8);
  EXPECT_NEAR(size({0, 0, z}), 0.5e-6 + 0.5 * 10e-6, 1e-8);
  EXPECT_NEAR(size({-10e-6, 0, z + 4e-6}), 2.5e-6, 1e-8);
  EXPECT_DOUBLE_EQ(size({10e-6, 0, -z}), 12e-6);
}

TEST(SizeField, ImprintsGetEightElements) {
  CellMeshConfig config;
  config.imprints = {{{5e-6, 0}, 0.5e-6, +1}};
  const double along = SizeField(config)(pointOnSphere({5.5e-6, 0}, +1, 28e-6));
  EXPECT_LT(along, 2 * M_PI * 0.5e-6 / 8);
  EXPECT_GT(along, 2 * M_PI * 0.5e-6 / 11);
}

TEST(SizeField, LayersLimitItToTheirThickness) {
  CellMeshConfig config;
  config.radii = {28e-6, 26e-6, 3e-6};
  const SizeField size(config);
  const auto at = [&](double from_centre) { return size(from_centre * Vector3d(0.6, 0, -0.8)); };
  EXPECT_NEAR(at(27e-6), 2.5e-6, 1e-15);
  EXPECT_NEAR(at(28e-6), 2.5e-6, 1e-15);
  EXPECT_NEAR(at(23e-6), 2.5e-6 + 1e-6, 1e-15);
  EXPECT_NEAR(at(0), 2e-6, 1e-15);
  EXPECT_NEAR(at(3e-6), 2e-6, 1e-15);
  EXPECT_NEAR(at(9e-6), 4e-6, 1e-15);
  config.radii = {28e-6};
  EXPECT_DOUBLE_EQ(SizeField(config)({0, 0, 0}), 12e-6);
}

TEST(SizeField, NowhereGrowsFasterThanAsked) {
  CellMeshConfig config = needleCell({10e-6, 5e-6});
  config.radii = {28e-6, 25e-6, 6e-6};
  config.growth = 0.4;
  config.refinements.push_back({CellMeshConfig::Shape::kCircle, {10e-6, 5e-6}, kTipRadius, +1, kTipRadius / 10});
  const SizeField size(config);
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> coordinate(-20e-6, 20e-6), step(-1e-6, 1e-6);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d point(coordinate(generator), coordinate(generator), coordinate(generator));
    const Vector3d by(step(generator), step(generator), step(generator));
    EXPECT_LE(std::abs(size(point + by) - size(point)), 0.4 * by.norm() + 1e-12);
  }
}

TEST(CircleOnSphere, DistanceIsThatOfTheNearestPoint) {
  const CircleOnSphere circle({0.5, -0.3}, 0.3, +1, 1);
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (int i = 0; i < 200; ++i) {
    const Vector3d point(coordinate(generator), coordinate(generator), coordinate(generator));
    double nearest = 10;
    for (int j = 0; j < 20000; ++j) {
      const double angle = 2 * M_PI * j / 20000;
      const Eigen::Vector2d xy(0.5 + 0.3 * std::cos(angle), -0.3 + 0.3 * std::sin(angle));
      nearest = std::min(nearest, (point - Vector3d(xy.x(), xy.y(), std::sqrt(1 - xy.squaredNorm()))).norm());
    }
    EXPECT_NEAR(circle.distance(point), nearest, 1e-3 * 0.3);
  }
}

TEST(CircleOnSphere, ProjectsOntoSphereAndCylinder) {
  const CircleOnSphere circle({0.5, -0.3}, 0.3, -1, 2);
  const Vector3d point = circle.project({0.9, 0.4, 1});
  EXPECT_NEAR(point.norm(), 2, 1e-15);
  EXPECT_NEAR((point.head<2>() - circle.centre()).norm(), 0.3, 1e-15);
  EXPECT_LT(point.z(), 0);
  EXPECT_NEAR(circle.distance(point), 0, 1e-3 * 0.3);
}

}  // namespace
}  // namespace microinjection
