#include "operation/teleoperation/virtual_hand.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

TEST(VirtualHand, YieldsToAConstantForceByItsStiffness) {
  VirtualHandConfig config;
  VirtualHand hand(config, Eigen::Vector3d::Zero());
  const Eigen::Vector3d force(0, 0, 0.5);
  for (int i = 0; i < 5000; ++i) hand.step(Eigen::Vector3d::Zero(), force, 1e-3);
  EXPECT_LT((hand.position() - force / config.stiffness).norm(), 1e-9);
}

TEST(VirtualHand, SwingsAsMassDamperAndSpringDo) {
  VirtualHandConfig config;
  config.damping = 1;
  VirtualHand hand(config, Eigen::Vector3d::Zero());
  const double force = 0.4, dt = 1e-5;
  const double zeta = config.damping / (2 * std::sqrt(config.mass * config.stiffness));
  const double omega = std::sqrt(config.stiffness / config.mass), damped = omega * std::sqrt(1 - zeta * zeta);
  for (int i = 1; i <= 20000; ++i) {
    hand.step(Eigen::Vector3d::Zero(), {force, 0, 0}, dt);
    const double t = i * dt;
    const double exact =
        force / config.stiffness *
        (1 - std::exp(-zeta * omega * t) * (std::cos(damped * t) + zeta * omega / damped * std::sin(damped * t)));
    ASSERT_NEAR(hand.position().x(), exact, 2e-3 * force / config.stiffness) << "at " << t;
  }
}

TEST(VirtualHand, FollowsWhereItMeansToBe) {
  VirtualHand hand({}, Eigen::Vector3d::Zero());
  Eigen::Vector3d meant = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3000; ++i) {
    meant.z() = 0.05 * 1e-3 * i;  // 50 mm/s
    hand.step(meant, Eigen::Vector3d::Zero(), 1e-3);
  }
  EXPECT_LT((hand.position() - meant).norm(), 1e-6);
}

TEST(VirtualHand, StaysStableOverALongStep) {
  VirtualHand hand({}, Eigen::Vector3d(0.1, 0, 0));
  for (int i = 0; i < 100; ++i) hand.step(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.5);
  EXPECT_LT(hand.position().norm(), 1e-6);
}

}  // namespace
}  // namespace microinjection
