// A device that was switched off and on counts from 0 where it stands. No position that it reports then is believed
// before the operator has enabled it again, and nothing moves.

#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

template <typename Tested>
class ResetTest : public DriverTest<Tested> {
 protected:
  bool toldOfIt() const {
    const auto& driver = this->rig_->driver();
    return driver.state() == ManipulatorDevice::State::kFault &&
           driver.reason().find("coordinates began anew") != std::string::npos;
  }
  void startAt(const Eigen::Vector3d& place) {
    this->rig_.reset();
    this->start();
    this->moveAndCheck(place);
  }
  /// `command`, at each step, goes on all the time.
  void expectNotBelieved(const std::function<void()>& command = nullptr) {
    auto& rig = *this->rig_;
    const int moves = rig.device().movesBegun();
    bool told = false;
    rig.run(8, [&] {
      if (command) command();
      told = told || toldOfIt();
      EXPECT_FALSE(told && rig.driver().reading());
    });
    ASSERT_TRUE(toldOfIt()) << rig.driver().reason();
    EXPECT_EQ(rig.device().movesBegun(), moves);
    rig.driver().clearFault();
    ASSERT_TRUE(rig.runUntilReady()) << rig.driver().reason();
    expectNear(rig.read(), rig.place(), Tested::kTold);
    rig.run(0.5);
    EXPECT_EQ(rig.device().movesBegun(), moves);
    this->moveAndCheck();
  }
  Eigen::Vector3d zero() const { return Tested::config().joints.origin; }
};
TYPED_TEST_SUITE(ResetTest, AllMoveByMove, Names);

TYPED_TEST(ResetTest, AtRestItIsAFault) {
  this->startAt(kPlace);
  this->rig_->inject("error:RESET");
  this->expectNotBelieved();
}

TYPED_TEST(ResetTest, WithThePulledCableItIsAFault) {
  this->startAt(kPlace);
  this->rig_->wire().disconnectCable();
  this->rig_->run(0.2);
  this->rig_->inject("error:RESET");
  this->rig_->wire().connectCable();
  this->expectNotBelieved();
}

TYPED_TEST(ResetTest, UnderWayItIsAFault) {
  for (const Eigen::Vector3d& goal : {Eigen::Vector3d(3 * kPlace), Eigen::Vector3d(-3 * kPlace), this->zero()}) {
    for (const double after : {0.1, 0.25, 0.4, 0.45, 0.5, 0.52}) {
      SCOPED_TRACE(testing::Message() << goal.transpose() << ", after " << after << " s");
      this->startAt(kPlace);
      this->rig_->driver().moveTo(goal, 0.2e-3);
      this->rig_->run(after);
      ASSERT_TRUE(this->rig_->runUntil([&] { return this->rig_->device().moves(); }, 0.1)) << "the next part";
      this->rig_->inject("error:RESET");
      this->expectNotBelieved();
    }
  }
}

TYPED_TEST(ResetTest, WhileItFollowsItIsAFault) {
  for (const Eigen::Vector3d& velocity : {Eigen::Vector3d(0.1e-3, -0.05e-3, 0.02e-3), {-0.1e-3, 0.05e-3, -0.02e-3}}) {
    this->startAt(kPlace);
    Eigen::Vector3d goal = kPlace;
    const auto follow = [&] {
      goal += velocity * 1e-3;
      this->rig_->driver().follow(goal, velocity);
    };
    this->rig_->run(0.2, follow);
    ASSERT_TRUE(this->rig_->runUntil(
        [&] {
          follow();
          return this->rig_->device().moves();
        },
        1));
    this->rig_->inject("error:RESET");
    this->expectNotBelieved(follow);
  }
}

/// To be switched on takes it some time, in which it does not answer. Who enables it meanwhile has not been told.
TYPED_TEST(ResetTest, ASilenceBeforeDoesNotHideIt) {
  for (const bool moves : {false, true}) {
    for (const bool enables : {false, true}) {
      SCOPED_TRACE(testing::Message() << "moves: " << moves << ", enables: " << enables);
      this->startAt(kPlace);
      if (moves) this->rig_->driver().moveTo(-3 * kPlace, 0.2e-3);
      this->rig_->run(0.2);
      this->rig_->inject("silence:4");
      this->rig_->inject("error:RESET");
      this->expectNotBelieved([&] {
        if (enables && !this->toldOfIt()) this->rig_->driver().clearFault();
      });
    }
  }
}

/// Somebody who turns its knob afterwards hides it, but not from what is set in the device: that is said again.
TYPED_TEST(ResetTest, WhatIsSetIsSaidAgainAfterAJump) {
  this->startAt(kPlace);
  auto& rig = *this->rig_;
  rig.driver().moveTo(1.5 * kPlace, 0.05e-3);
  ASSERT_TRUE(rig.runUntilArrived());
  rig.inject("error:RESET");
  rig.run(1e-3);
  rig.device().shiftByHand({20e-6, 30e-6, 40e-6});
  rig.run(3);
  if (!TypeParam::kMovedByHand) {
    EXPECT_TRUE(this->toldOfIt());
    return;
  }
  ASSERT_EQ(rig.driver().state(), ManipulatorDevice::State::kReady) << rig.driver().reason();
  expectNear(rig.read(), rig.place(), TypeParam::kTold);
  const Eigen::Vector3d from = rig.place(), way = 0.5 * kPlace;
  rig.driver().moveTo(from + way, 0.05e-3);
  ASSERT_TRUE(rig.runUntil([&] { return rig.device().moves(); }, 1));
  const double begin = rig.time();
  ASSERT_TRUE(rig.runUntilArrived());
  EXPECT_GT(rig.time() - begin, 0.99 * way.norm() / 0.05e-3);
  expectNear(rig.place(), from + way, TypeParam::kStep);
}

TYPED_TEST(ResetTest, ZeroIsAPlaceLikeOthers) {
  this->start();
  auto& rig = *this->rig_;
  const Eigen::Vector3d along(0, 0, 40e-6);
  for (const Eigen::Vector3d& place : {this->zero(), kPlace, this->zero()}) this->moveAndCheck(place);
  for (int i = 0; i < 12; ++i) {  // there and back through it, stopped and disturbed on the way
    this->moveAndCheck(this->zero() + along);
    rig.driver().moveTo(this->zero() - along, 0.1e-3);
    rig.run(0.35 + 0.01 * i);
    if (i % 3 == 0) rig.driver().stop();
    if (i % 3 == 1) rig.inject("silence:0.1");
    rig.run(2);
    ASSERT_EQ(rig.driver().state(), ManipulatorDevice::State::kReady) << rig.driver().reason();
    rig.inject(i % 2 == 0 ? "drop:1" : "deaf:4");
    this->moveAndCheck(this->zero());
  }
}

TYPED_TEST(ResetTest, ASessionThatIsLostTwiceOnTheWayToZeroIsNone) {
  for (double later = 0.3; later < 0.9; later += 0.004) {
    SCOPED_TRACE(later);
    this->startAt(kPlace);
    auto& rig = *this->rig_;
    rig.driver().moveTo(this->zero(), 0.2e-3);
    rig.run(0.1);
    rig.inject("drop:1");
    rig.inject("drop:1@" + std::to_string(rig.time() + later));
    ASSERT_TRUE(rig.runUntilArrived()) << rig.driver().reason();
    rig.run(2);
    ASSERT_EQ(rig.driver().state(), ManipulatorDevice::State::kReady) << rig.driver().reason();
    expectNear(rig.place(), this->zero(), TypeParam::kStep);
  }
}

}  // namespace
}  // namespace microinjection
