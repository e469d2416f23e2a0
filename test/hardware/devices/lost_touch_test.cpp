// A pose that is told is a true one: who hears nothing from a device says so soon, and lets nothing go on by itself.

#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

constexpr double kLargestError = 0.2 * 25e-6;  // m, of a position that is told: 0.2 s of the ramp

template <typename Tested>
class LostTouchTest : public DriverTest<Tested> {
 protected:
  /// Follows a slow ramp and is disturbed under way.
  void followUntil(const std::string& fault) {
    this->make();
    this->start();
    stream(0.73);
    this->rig_->inject(fault);
  }
  void stream(double duration, const std::function<void()>& each = nullptr) {
    const Eigen::Vector3d velocity(20e-6, -10e-6, 0);
    this->rig_->run(duration, [&] {
      goal_ += velocity * 1e-3;
      this->rig_->driver().follow(goal_, velocity);
      if (each) each();
    });
  }
  Eigen::Vector3d goal_ = Eigen::Vector3d::Zero();
};
TYPED_TEST_SUITE(LostTouchTest, AllTested, Names);

TYPED_TEST(LostTouchTest, ASilentDevicesPositionIsNotToldForLong) {
  this->followUntil("silence:8");
  auto& rig = *this->rig_;
  ASSERT_TRUE(rig.driver().reading());
  const double from = rig.time();
  const auto isReady = [&] { return rig.driver().state() == ManipulatorDevice::State::kReady; };
  while (isReady() && rig.time() < from + 5) {
    this->stream(1e-3);
    if (rig.driver().reading()) EXPECT_LT((rig.read() - rig.place()).norm(), kLargestError);
  }
  EXPECT_LT(rig.time() - from, TypeParam::kLongestBlind);
  EXPECT_NE(rig.driver().reason(), "");
  this->stream(5, [&] { EXPECT_FALSE(rig.driver().reading()); });
  EXPECT_EQ(rig.driver().state(), ManipulatorDevice::State::kFault);
}

TYPED_TEST(LostTouchTest, AnInterruptedCommandIsNotTakenUpAgain) {
  this->followUntil(TypeParam::kSilence);
  auto& rig = *this->rig_;
  const Eigen::Vector3d ahead = this->goal_ + Eigen::Vector3d(0, 0, 50e-6);
  rig.run(1e-3, [&] { rig.driver().follow(ahead, Eigen::Vector3d::Zero()); });
  ASSERT_TRUE(rig.runUntil([&] { return rig.driver().state() != ManipulatorDevice::State::kReady; }, 2));
  ASSERT_TRUE(rig.runUntilReady());
  const Eigen::Vector3d there = rig.place();
  rig.run(2, [&] { EXPECT_FALSE(rig.device().moves()); });
  expectNear(rig.place(), there, 0);
  expectNear(rig.read(), there, TypeParam::kTold);
  this->moveAndCheck();
}

TYPED_TEST(LostTouchTest, OneLostAnswerIsGotOver) {
  this->followUntil(TypeParam::kLostReply);
  auto& rig = *this->rig_;
  this->stream(2, [&] {
    ASSERT_EQ(rig.driver().state(), ManipulatorDevice::State::kReady) << rig.driver().reason();
    // None while the answer is overdue.
    if (rig.driver().reading()) EXPECT_LT((rig.read() - rig.place()).norm(), kLargestError);
  });
  ASSERT_TRUE(rig.runUntilArrived());
  expectNear(rig.place(), this->goal_, TypeParam::kStep);
}

TYPED_TEST(LostTouchTest, ADriverThatWasHeldUpBlamesNotTheDevice) {
  this->make();
  this->start();
  auto& rig = *this->rig_;
  for (int i = 0; i < 20; ++i) {
    rig.run(0.31);
    rig.driver().step(rig.time() + 0.3);  // a step that comes late
    ASSERT_EQ(rig.driver().state(), ManipulatorDevice::State::kReady) << rig.driver().reason();
    rig.run(0.3);
  }
}

}  // namespace
}  // namespace microinjection
