#include "hardware/manipulator/solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace microinjection {
namespace {

const Eigen::Vector3d kHere = Eigen::Vector3d::Zero();

Solid box(double x, double y, double z) { return {Solid::Shape::kBox, Eigen::Isometry3d::Identity(), {x, y, z}}; }

Solid cylinder(double radius, double half_length) {
  return {Solid::Shape::kCylinder, Eigen::Isometry3d::Identity(), {radius, 0, half_length}};
}

TEST(Solid, DistancesOfAPointAreThoseOfGeometry) {
  const Solid plate = box(1e-3, 2e-3, 3e-3);
  EXPECT_NEAR(plate.nearest({4e-3, 0, 1e-3}).distance, 3e-3, 1e-15);
  EXPECT_NEAR(plate.nearest({4e-3, 6e-3, 15e-3}).distance, 13e-3, 1e-15);  // 3, 4, 12 from the corner
  EXPECT_EQ(plate.nearest({0.5e-3, 1e-3, -2e-3}).distance, 0);
  const Solid rod = cylinder(1e-3, 3e-3);
  EXPECT_NEAR(rod.nearest({3e-3, 4e-3, 2e-3}).distance, 4e-3, 1e-15);
  EXPECT_NEAR(rod.nearest({2.4e-3, 3.2e-3, -7e-3}).distance, 5e-3, 1e-15);  // 3 beside the rim, 4 below it
  EXPECT_EQ(rod.nearest({0, 0, 0}).distance, 0);
  const Solid ball{Solid::Shape::kSphere, Eigen::Isometry3d::Identity(), {1e-3, 0, 0}};
  EXPECT_NEAR(ball.nearest({3e-3, 0, 4e-3}).distance, 4e-3, 1e-15);
  EXPECT_EQ(ball.nearest(kHere).distance, 0);
}

/// A body of 50 mm, a micrometre away: what the absolute tolerances of general libraries are made for least.
TEST(Solid, MicrometresBetweenBodiesOfCentimetres) {
  for (const double gap : {1e-6, 1e-7, 1e-8}) {
    const Capsule upright{{3e-6, 4e-6, gap + 0.5e-3}, {3e-6, 4e-6, 50e-3}, 0.5e-3};
    Solid floor = cylinder(18e-3, 85e-6);
    floor.pose.translation().z() = -85e-6;
    EXPECT_NEAR(distance(upright, kHere, floor), gap, 1e-10);
    // Crossed at right angles, and askew: the distance of the axes less the radii.
    const Solid rod = cylinder(30e-6, 25e-3);
    const Capsule crossed{{0.53e-3 + gap, -18e-3, 7e-3}, {0.53e-3 + gap, 32e-3, 7e-3}, 0.5e-3};
    EXPECT_NEAR(distance(crossed, kHere, rod), gap, 1e-10);
    const Capsule askew{{0.53e-3 + gap, -18e-3, 3e-3}, {0.53e-3 + gap, 32e-3, 9e-3}, 0.5e-3};
    EXPECT_NEAR(distance(askew, kHere, rod), gap, 1e-10);
    const Capsule parallel{{0.53e-3 + gap, 0, -9e-3}, {0.53e-3 + gap, 0, 41e-3}, 0.5e-3};
    EXPECT_NEAR(distance(parallel, kHere, rod), gap, 1e-10);
  }
}

class RandomSolids : public testing::Test {
 protected:
  double uniform(double size) { return size * std::uniform_real_distribution<double>(-1, 1)(random_); }
  Eigen::Vector3d point(double size) { return {uniform(size), uniform(size), uniform(size)}; }

  Solid solid() {
    Solid result;
    result.shape = static_cast<Solid::Shape>(std::uniform_int_distribution<int>(0, 2)(random_));
    result.half = point(1).cwiseAbs() * 0.5 + Eigen::Vector3d::Constant(0.05);
    result.pose.linear() = Eigen::Quaterniond(uniform(1), uniform(1), uniform(1), uniform(1)).normalized().matrix();
    result.pose.translation() = point(1);
    return result;
  }

  std::mt19937_64 random_{5};
};

TEST_F(RandomSolids, TheGradientPointsAwayFromTheNearestPoint) {
  for (int i = 0; i < 2000; ++i) {
    const Solid body = solid();
    const Eigen::Vector3d at = point(2);
    const Solid::Nearest nearest = body.nearest(at);
    if (nearest.distance == 0) continue;
    EXPECT_NEAR(nearest.away.norm(), 1, 1e-12);
    // The point that it names is of the solid, and none of the solid's is nearer.
    EXPECT_NEAR(body.nearest(at - nearest.distance * nearest.away).distance, 0, 1e-12);
    EXPECT_NEAR(body.nearest(at + 0.5 * nearest.away).distance, nearest.distance + 0.5, 1e-12);
  }
}

TEST_F(RandomSolids, DistanceOfACapsuleIsTheSmallestOfItsPoints) {
  for (int i = 0; i < 500; ++i) {
    const Solid body = solid();
    const Capsule capsule{point(2), point(2), 0.1};
    double smallest = 1e9;
    const int n = 2000;
    for (int j = 0; j <= n; ++j) {
      const Eigen::Vector3d at = capsule.start + (capsule.end - capsule.start) * j / n;
      smallest = std::min(smallest, body.nearest(at).distance - capsule.radius);
    }
    const double found = distance(capsule, kHere, body);
    EXPECT_LE(found, smallest + 1e-9);
    EXPECT_GE(found, smallest - (capsule.end - capsule.start).norm() / (2 * n));
    // Asked only whether it is far enough: never above the truth.
    const double bound = distance(capsule, kHere, body, 0.3);
    EXPECT_LE(bound, found + 1e-9);
    if (found > 0.3 + 1e-9) EXPECT_GT(bound, 0.3);
  }
}

TEST_F(RandomSolids, DistanceOnAWayIsTheSmallestOnIt) {
  for (int i = 0; i < 300; ++i) {
    const Solid body = solid();
    const Capsule capsule{point(1), point(1), 0.1};
    const Eigen::Vector3d from = point(2), to = point(2);
    double smallest = 1e9;
    const int n = 1000;
    for (int j = 0; j <= n; ++j) smallest = std::min(smallest, distance(capsule, from + (to - from) * j / n, body));
    const double found = distanceAlongPath(capsule, from, to, body);
    EXPECT_LE(found, smallest + 1e-8);
    EXPECT_GE(found, smallest - (to - from).norm() / (2 * n));
    const double bound = distanceAlongPath(capsule, from, to, body, 0.2);
    EXPECT_LE(bound, found + 1e-8);
    if (found > 0.2 + 1e-8) EXPECT_GT(bound, 0.2);
  }
}

}  // namespace
}  // namespace microinjection
