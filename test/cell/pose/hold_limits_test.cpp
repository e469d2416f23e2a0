#include "cell/pose/hold_limits.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <utility>

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

/// Of friction about the lip of a turning cell that is pressed by `axial` (N): moment (N m) and force across the tube
/// (N).
std::pair<double, double> frictionOfTurning(double axial) {
  const double alpha = std::asin(kSealRadius / kHeldRadius);
  double moment = 0, across = 0;
  const int count = 1000;
  for (int i = 0; i < count; ++i) {
    const double phi = 2 * M_PI * (i + 0.5) / count;
    const Vector3d arm =
        kHeldRadius * Vector3d(std::sin(alpha) * std::cos(phi), std::sin(alpha) * std::sin(phi), std::cos(alpha));
    const double friction = kLipFriction * axial / std::cos(alpha) / count;
    const Vector3d force = -friction * Vector3d(0, -1, 0).cross(arm).normalized();
    moment += arm.cross(force).y();
    across += force.x();
  }
  return {std::abs(moment), std::abs(across)};
}

TEST(HoldLimits, ACellThatYieldsAcrossTheTubeChangesTheArm) {
  const double stiffness = 0.04;
  const HoldLimits soft(kSuctionForce, kSealRadius, kHeldRadius, kLipFriction, {kSealRadius, stiffness});
  const double beside = 30e-6;
  const Vector3d point(beside, 0, -std::sqrt(kHeldRadius * kHeldRadius - beside * beside));
  const double load = soft.largest(point, {0, 0, 1});
  EXPECT_GT(load, holdLimits().largest(point, {0, 0, 1}));
  const auto [moment, across] = frictionOfTurning(kSuctionForce + load);
  EXPECT_NEAR(load * (beside - across / stiffness) / moment, 1, 1e-9);

  const double pull = soft.largest(point, {0, 0, -1});
  EXPECT_LT(pull, holdLimits().largest(point, {0, 0, -1}));
  const auto [less, towards] = frictionOfTurning(kSuctionForce - pull);
  EXPECT_NEAR(pull * (beside + towards / stiffness) / less, 1, 1e-9);

  // A softer seat wedges where a rigid one turns: only tipping over the lip is left, as with much friction.
  const HoldLimits softer(kSuctionForce, kSealRadius, kHeldRadius, 2 * kLipFriction, {kSealRadius, stiffness / 10});
  EXPECT_LT(holdLimits(2 * kLipFriction).largest(point, {0, 0, 1}), holdLimits(5).largest(point, {0, 0, 1}));
  EXPECT_EQ(softer.largest(point, {0, 0, 1}), holdLimits(5).largest(point, {0, 0, 1}));
}

TEST(HoldLimits, TheShiftEndsWhereTheSealWouldOpen) {
  const double tangent = kSealRadius / std::sqrt(kHeldRadius * kHeldRadius - kSealRadius * kSealRadius);
  const double stiffness = 0.4, beside = 38e-6;
  const Vector3d point(beside, 0, -std::sqrt(kHeldRadius * kHeldRadius - beside * beside));
  const HoldLimits soft(kSuctionForce, kSealRadius, kHeldRadius, 0.3, {kSealRadius, stiffness});
  const double load = soft.largest(point, {0, 0, 1}), axial = kSuctionForce + load;
  // As one half of the axial push times the slope: HoldLimits::opening().
  EXPECT_NEAR(load * (beside - axial * tangent / 2 / stiffness) / (soft.turning() * axial / kSuctionForce), 1, 1e-9);
}

TEST(HoldLimits, WithoutSuctionHoldsNothing) {
  EXPECT_EQ(HoldLimits(0, kSealRadius, kHeldRadius, 1).largest({0, 0, -kHeldRadius}, {1, 0, 0}), 0);
}

}  // namespace
}  // namespace microinjection
