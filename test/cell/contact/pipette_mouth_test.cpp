#include "cell/contact/pipette_mouth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "base/finite_difference.h"

namespace microinjection {
namespace {

using Eigen::Vector3d;

constexpr double kBore = 12e-6, kOutside = 30e-6, kLipEdge = 2e-6;  // m

PipetteMouth mouth(double side = 1) { return PipetteMouth(kBore, kOutside, kLipEdge, side); }

TEST(PipetteMouth, DistancesThatOneCanSee) {
  const PipetteMouth above = mouth();
  EXPECT_NEAR(above.distance({20e-6, 0, 0}), 0, 1e-18);          // the flat end between its two edges
  EXPECT_NEAR(above.distance({0, 20e-6, -3e-6}), 3e-6, 1e-18);   // below it
  EXPECT_NEAR(above.distance({0, 0, 15e-6}), kBore, 1e-18);      // on the axis, in the bore
  EXPECT_NEAR(above.distance({-11e-6, 0, 15e-6}), 1e-6, 1e-18);  // near its wall
  EXPECT_NEAR(above.distance({35e-6, 0, 15e-6}), 5e-6, 1e-18);   // outside of the tube
  EXPECT_NEAR(above.distance({20e-6, 0, 10e-6}), -8e-6, 1e-18);  // in the wall: 8 um from the bore
  const double slant = std::sqrt(2.0) * kLipEdge - kLipEdge;     // where the square edge of the bore would be
  EXPECT_NEAR(above.distance({kBore, 0, 0}), slant, 1e-18);
}

TEST(PipetteMouth, BelowTheCellItIsTheMirrorImage) {
  const PipetteMouth above = mouth(), below = mouth(-1);
  for (const Vector3d& point : {Vector3d(11e-6, 3e-6, -1e-6), Vector3d(25e-6, -1e-6, -2e-6), Vector3d(2e-6, 0, 4e-6)}) {
    const Vector3d mirrored(point.x(), point.y(), -point.z());
    EXPECT_EQ(below.distance(mirrored), above.distance(point));
    EXPECT_EQ(below.gap(mirrored).normal.z(), -above.gap(point).normal.z());
  }
}

TEST(PipetteMouth, DerivativesAreThoseOfTheDistance) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> out(0.3, 3), turn(0, 2 * M_PI), up(-1.5, 2);
  int checked = 0;
  for (const double side : {1.0, -1.0}) {
    const PipetteMouth at = mouth(side);
    for (int i = 0; i < 400; ++i) {
      const double r = out(random) * kBore, angle = turn(random), z = up(random) * kBore;
      const Vector3d point(r * std::cos(angle), r * std::sin(angle), z);
      const double below = side * z - kLipEdge, beyond = r - (kOutside - kLipEdge), within = r - kBore - kLipEdge;
      const double jump = 0.02e-6;  // the curvature jumps on the borders of its regions, the normal in the wall
      if (std::min({std::abs(below), std::abs(beyond), std::abs(within)}) < jump || at.distance(point) < -kLipEdge)
        continue;
      const Gap gap = at.gap(point);
      EXPECT_EQ(gap.distance, at.distance(point));
      EXPECT_NEAR(gap.normal.norm(), 1, 1e-12);
      EXPECT_LT((gap.curvature * gap.normal).norm() * kLipEdge, 1e-9);
      const auto distance = [&](const Eigen::VectorXd& x) {
        return Eigen::VectorXd(Eigen::VectorXd::Constant(1, at.distance(kLipEdge * Vector3d(x)) / kLipEdge));
      };
      const auto normal = [&](const Eigen::VectorXd& x) {
        return Eigen::VectorXd(at.gap(kLipEdge * Vector3d(x)).normal);
      };
      const Eigen::VectorXd x = point / kLipEdge;
      EXPECT_LT(derivativeError(distance, x, gap.normal.transpose(), 1e-5), 1e-6) << point.transpose();
      EXPECT_LT(derivativeError(normal, x, kLipEdge * gap.curvature, 1e-5), 1e-6) << point.transpose();
      ++checked;
    }
  }
  EXPECT_GT(checked, 300);
}

TEST(PipetteMouth, TouchesASphereWithoutEnteringIt) {
  const PipetteMouth at = mouth();
  const double cell = 40e-6, distance = at.touchDistance(cell), circle = at.touchRadius(cell);
  EXPECT_LT(circle, at.crestRadius());
  double nearest = 1;
  for (double angle = 0; angle < M_PI; angle += 1e-4) {
    // The sphere's centre lies `distance` below the crest.
    const Vector3d point(cell * std::sin(angle), 0, cell * std::cos(angle) - distance);
    nearest = std::min(nearest, at.distance(point));
  }
  EXPECT_NEAR(nearest, 0, 1e-11);
  EXPECT_NEAR(at.distance({circle, 0, std::sqrt(cell * cell - circle * circle) - distance}), 0, 1e-18);
}

TEST(PipetteMouth, RefusesATubeThatIsNone) {
  EXPECT_THROW(PipetteMouth(kBore, kBore, kLipEdge, 1), std::invalid_argument);
  EXPECT_THROW(PipetteMouth(0, kOutside, kLipEdge, 1), std::invalid_argument);
  EXPECT_THROW(PipetteMouth(kBore, kOutside, 10e-6, 1), std::invalid_argument);
  EXPECT_THROW(PipetteMouth(kBore, kOutside, kLipEdge, 0), std::invalid_argument);
  EXPECT_THROW(PipetteMouth(kBore, NAN, kLipEdge, 1), std::invalid_argument);
  EXPECT_NO_THROW(PipetteMouth(kBore, kOutside, 9e-6, 1));  // a round lip, without a flat end
}

}  // namespace
}  // namespace microinjection
