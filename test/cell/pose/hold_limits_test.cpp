#include "cell/pose/hold_limits.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace microinjection {
namespace {

using Eigen::Vector3d;

constexpr double kSuctionForce = 2e-7, kSealRadius = 13e-6, kHeldRadius = 40e-6, kLipFriction = 0.1;

HoldLimits holdLimits(double friction = kLipFriction) {
  return HoldLimits(kSuctionForce, kSealRadius, kHeldRadius, friction);
}

TEST(HoldLimits, OfLoadsThroughTheCentre) {
  const double tangent = kSealRadius / std::sqrt(kHeldRadius * kHeldRadius - kSealRadius * kSealRadius);
  EXPECT_DOUBLE_EQ(holdLimits().largest(Vector3d::Zero(), {0, 0, -1}), kSuctionForce);
  EXPECT_NEAR(holdLimits().largest(Vector3d::Zero(), {0, 3, 0}), kSuctionForce * tangent, 1e-20);
  EXPECT_NEAR(holdLimits(5).sideways(), kSuctionForce * tangent, 1e-20);  // friction does not hold it
  EXPECT_NEAR(holdLimits().opening(), kSuctionForce * tangent / 2, 1e-20);
  EXPECT_EQ(holdLimits().largest(Vector3d::Zero(), {0, 0, 1}), std::numeric_limits<double>::infinity());
  // Slanted by less than alpha it presses the cell onto the lip.
  EXPECT_EQ(holdLimits().largest(Vector3d::Zero(), {0.9 * tangent, 0, 1}), std::numeric_limits<double>::infinity());
  EXPECT_LT(holdLimits().largest(Vector3d::Zero(), {1.1 * tangent, 0, 1}), 1e-5);
}

TEST(HoldLimits, TurningIsTheSumOfFrictionOverTheSeat) {
  const double alpha = std::asin(kSealRadius / kHeldRadius);
  double moment = 0;
  const int count = 1000;
  for (int i = 0; i < count; ++i) {
    const double phi = 2 * M_PI * (i + 0.5) / count;
    const Vector3d arm(std::sin(alpha) * std::cos(phi), std::sin(alpha) * std::sin(phi), std::cos(alpha));
    moment +=
        Vector3d::UnitY().cross(arm).norm() * kHeldRadius * kLipFriction * kSuctionForce / std::cos(alpha) / count;
  }
  EXPECT_NEAR(holdLimits().turning() / moment, 1, 1e-9);
  EXPECT_NEAR(holdLimits().spinning(), kLipFriction * kSuctionForce / std::cos(alpha) * kSealRadius, 1e-20);
}

TEST(HoldLimits, AtThePoleItTurnsOrTips) {
  const double alpha = std::asin(kSealRadius / kHeldRadius);
  EXPECT_NEAR(holdLimits(0.05).atPole(), holdLimits(0.05).turning() / kHeldRadius, 1e-18);
  EXPECT_NEAR(holdLimits(5).atPole(), kSuctionForce * std::tan(alpha / 2), 1e-18);
}

TEST(HoldLimits, BesideTheAxisAForceAlongTheTubeTurnsTheCell) {
  const double beside = 30e-6, k = holdLimits().turning() / (kSuctionForce * kHeldRadius);
  const Vector3d point(beside, 0, -std::sqrt(kHeldRadius * kHeldRadius - beside * beside));
  EXPECT_NEAR(holdLimits().largest(point, {0, 0, 1}), kSuctionForce * k / (beside / kHeldRadius - k), 1e-18);
  // With much friction it tips over the lip: force times its arm beyond the lip is suction times the circle's radius.
  EXPECT_NEAR(holdLimits(5).largest(point, {0, 0, 1}), kSuctionForce * kSealRadius / (beside - kSealRadius), 1e-18);
}

TEST(HoldLimits, ASoftCellComesOffAtTheCircleWhereItLeavesTheLip) {
  const double released = 12e-6, share = released / kSealRadius, tangent = std::tan(std::asin(released / kHeldRadius));
  const HoldLimits soft(kSuctionForce, kSealRadius, kHeldRadius, kLipFriction,
                        {released, std::numeric_limits<double>::infinity()});
  const double pull = kSuctionForce * share * share;
  EXPECT_NEAR(soft.pull(), pull, 1e-20);
  EXPECT_NEAR(soft.largest(Vector3d::Zero(), {0, 0, -1}), pull, 1e-20);
  EXPECT_NEAR(soft.largest(Vector3d::Zero(), {1, 0, 0}), pull * tangent, 1e-20);
  EXPECT_NEAR(soft.opening(), pull * tangent / 2, 1e-20);
  EXPECT_EQ(soft.turning(), holdLimits().turning());
  EXPECT_EQ(holdLimits().pull(), kSuctionForce);
}

/// The moment of a load along the tube about a centre that friction has pushed across it, by quadrature about the lip.
TEST(HoldLimits, ACellThatGivesWayAcrossTheTubeShortensTheArm) {
  const double stiffness = 0.04, alpha = std::asin(kSealRadius / kHeldRadius);
  const HoldLimits soft(kSuctionForce, kSealRadius, kHeldRadius, kLipFriction, {kSealRadius, stiffness});
  const double beside = 30e-6;
  const Vector3d point(beside, 0, -std::sqrt(kHeldRadius * kHeldRadius - beside * beside));
  const double load = soft.largest(point, {0, 0, 1});
  EXPECT_GT(load, holdLimits().largest(point, {0, 0, 1}));
  double moment = 0, across = 0;
  const int count = 1000;
  for (int i = 0; i < count; ++i) {
    const double phi = 2 * M_PI * (i + 0.5) / count;
    const Vector3d arm =
        kHeldRadius * Vector3d(std::sin(alpha) * std::cos(phi), std::sin(alpha) * std::sin(phi), std::cos(alpha));
    const double friction = kLipFriction * (kSuctionForce + load) / std::cos(alpha) / count;
    const Vector3d force = -friction * Vector3d(0, -1, 0).cross(arm).normalized();
    moment += arm.cross(force).y();
    across += force.x();
  }
  EXPECT_NEAR(load * (beside - std::abs(across) / stiffness) / std::abs(moment), 1, 1e-9);

  // A softer seat wedges where a rigid one turns: only tipping over the lip is left, as with much friction.
  const HoldLimits softer(kSuctionForce, kSealRadius, kHeldRadius, 2 * kLipFriction, {kSealRadius, stiffness / 10});
  EXPECT_LT(holdLimits(2 * kLipFriction).largest(point, {0, 0, 1}), holdLimits(5).largest(point, {0, 0, 1}));
  EXPECT_EQ(softer.largest(point, {0, 0, 1}), holdLimits(5).largest(point, {0, 0, 1}));
  EXPECT_EQ(softer.largest(point, {0, 0, -1}), holdLimits(2 * kLipFriction).largest(point, {0, 0, -1}));
}

TEST(HoldLimits, WithoutSuctionHoldsNothing) {
  EXPECT_EQ(HoldLimits(0, kSealRadius, kHeldRadius, 1).largest({0, 0, -kHeldRadius}, {1, 0, 0}), 0);
}

}  // namespace
}  // namespace microinjection
