#include <gtest/gtest.h>

#include "operation/link/link_follower.h"
#include "operation/link/link_leader.h"
#include "operation/link/link_loop.h"

namespace microinjection {
namespace {

const Eigen::Vector3d kNeedle(1e-6, 2e-6, 60e-6);

/// Hand's and rig's end without a network between; the needle is where it is told to be at once.
class LinkEnds : public testing::Test {
 protected:
  /// One period in which the bridge wants the needle at `target` (m); empty: it holds.
  void step(const std::optional<Eigen::Vector3d>& target) {
    force_ = leader_.step(kStep);
    leader_.setTarget(force_ ? target : std::nullopt);
    const LinkPacket to_rig = leader_.packet();
    if (plugged_) follower_.receive(to_rig);
    goal_ = follower_.step({needle_, tip_force_, controller_}, kStep);
    if (goal_) *needle_ = *goal_;
    const LinkPacket to_hand = follower_.packet();
    if (plugged_) leader_.receive(to_hand);
  }
  void run(const std::optional<Eigen::Vector3d>& target, int steps) {
    for (int i = 0; i < steps; ++i) step(target);
  }

  LinkConfig config_;
  LinkLeader leader_{config_, kScale, 2e5, 77};
  LinkFollower follower_{config_};
  bool plugged_ = true;
  std::optional<Eigen::Vector3d> needle_ = kNeedle, tip_force_ = Eigen::Vector3d(Eigen::Vector3d::Zero());
  bool controller_ = true;
  std::optional<Eigen::Vector3d> goal_, force_;
};

const Eigen::Vector3d kMoved = kNeedle - Eigen::Vector3d(0, 0, 5e-6);

TEST_F(LinkEnds, NothingMovesBeforeTheHandIsTakenUp) {
  EXPECT_FALSE(leader_.needle());
  run(std::nullopt, 10);
  EXPECT_FALSE(goal_);
  EXPECT_EQ(*leader_.needle(), kNeedle);
  EXPECT_EQ(*force_, Eigen::Vector3d::Zero());
  EXPECT_EQ(follower_.holdReason(), "the hand's side holds");
}

TEST_F(LinkEnds, BeginsWhereTheNeedleIsAndGoesWhereTheHandWants) {
  run(std::nullopt, 10);
  step(kNeedle);
  ASSERT_TRUE(goal_);
  EXPECT_LT((*goal_ - kNeedle).norm(), 1e-15);
  run(kMoved, 2000);
  EXPECT_LT((*goal_ - kMoved).norm(), 1e-3 * (kMoved - kNeedle).norm());
}

TEST_F(LinkEnds, AHoldIsAtOnceAndTheNextEpochBeginsWhereTheNeedleIs) {
  run(std::nullopt, 10);
  step(kNeedle);
  run(kMoved, 2000);
  run(std::nullopt, 100);
  EXPECT_FALSE(goal_);
  const Eigen::Vector3d held = *needle_;
  step(held + Eigen::Vector3d(1e-3, 0, 0));  // the hand has gone elsewhere: its place counts anew
  ASSERT_TRUE(goal_);
  EXPECT_LT((*goal_ - held).norm(), 1e-12);
}

TEST_F(LinkEnds, ADeadLinkHoldsAndRendersNothingWithinItsTimeOut) {
  run(std::nullopt, 10);
  run(kNeedle, 500);
  plugged_ = false;
  const int steps = static_cast<int>(config_.timeout / kStep);
  run(kNeedle, steps - 2);
  EXPECT_TRUE(goal_);
  EXPECT_TRUE(force_);
  run(kNeedle, 4);
  EXPECT_FALSE(goal_);
  EXPECT_FALSE(force_);
  EXPECT_FALSE(leader_.needle());
  EXPECT_EQ(follower_.holdReason(), "no packets from the hand's side");
  plugged_ = true;
  const Eigen::Vector3d held = *needle_;
  run(kMoved, 1);
  EXPECT_FALSE(goal_);
  run(kMoved, 200);
  ASSERT_TRUE(goal_) << "a new epoch";
  EXPECT_LT((*goal_ - held).norm(), 1e-12);
}

TEST_F(LinkEnds, AnUntrustedNeedleEndsTheEpochForBothSides) {
  run(std::nullopt, 10);
  run(kNeedle, 500);
  const Eigen::Vector3d held = *needle_;
  needle_.reset();
  run(kNeedle, 3);
  EXPECT_FALSE(goal_);
  EXPECT_FALSE(leader_.needle());
  needle_ = held;
  step(kNeedle);
  EXPECT_FALSE(goal_) << "the old epoch's waves are over";
  run(kNeedle, 5);
  EXPECT_TRUE(goal_);
}

TEST_F(LinkEnds, ADeadControllerEndsTheEpochForBothSides) {
  run(std::nullopt, 10);
  run(kNeedle, 500);
  controller_ = false;
  run(kNeedle, 3);
  EXPECT_FALSE(goal_);
  EXPECT_FALSE(force_);
  EXPECT_FALSE(leader_.needle());
  EXPECT_EQ(follower_.holdReason(), "the controller is silent");
}

TEST_F(LinkEnds, ARigThatWasStartedAgainDoesNotJumpIntoAnEpoch) {
  run(std::nullopt, 10);
  step(kNeedle);
  run(kMoved, 3000);
  const Eigen::Vector3d held = *needle_;
  follower_ = LinkFollower(config_);
  for (int i = 0; i < 3000; ++i) {
    step(held);
    EXPECT_LT((*needle_ - held).norm(), 1e-9) << i;
  }
  EXPECT_TRUE(goal_);
}

TEST_F(LinkEnds, ABridgeThatWasStartedAgainIsHeard) {
  run(std::nullopt, 10);
  run(kNeedle, 500);
  leader_ = LinkLeader(config_, kScale, 2e5, 1077);
  run(std::nullopt, 3);
  EXPECT_FALSE(goal_);
  run(kNeedle, 3);
  EXPECT_TRUE(goal_);
}

TEST_F(LinkEnds, LateAndForeignPacketsChangeNothing) {
  run(std::nullopt, 10);
  const LinkPacket old = leader_.packet();
  run(kNeedle, 10);
  follower_.receive(old);
  LinkPacket bad = leader_.packet();
  bad.position_scale = std::nan("");
  bad.number += 100;
  follower_.receive(bad);
  step(kNeedle);
  ASSERT_TRUE(goal_);
  EXPECT_LT((*goal_ - kNeedle).norm(), 1e-15);
}

}  // namespace
}  // namespace microinjection
