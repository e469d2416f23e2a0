// A USB adapter with its latency timer holds answers back: slower turns, and no fault.

#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

template <typename Tested>
class SlowAnswersTest : public DriverTest<Tested> {
 protected:
  void SetUp() override {
    typename Tested::EmulatorConfig device;
    device.answer_time = 18e-3;  // s
    this->make(device);
    this->start();
  }
};
TYPED_TEST_SUITE(SlowAnswersTest, AllMoveByMove, Names);

TYPED_TEST(SlowAnswersTest, AbilitiesTellOfThem) {
  const ManipulatorAbilities slow = this->rig_->driver().abilities();
  this->make();
  this->start();
  const ManipulatorAbilities quick = this->rig_->driver().abilities();
  EXPECT_GT(slow.command_interval, quick.command_interval + 2 * 12e-3);
  EXPECT_GT(slow.latency, quick.latency + 2 * 12e-3);
}

TYPED_TEST(SlowAnswersTest, MovesAndStopsWithoutAFault) {
  auto& rig = *this->rig_;
  for (int i = 0; i < 6; ++i) {
    rig.driver().moveTo(kPlace * (i % 2 == 0 ? 3 : -3), 0.3e-3);
    rig.run(0.31 + 0.017 * i);
    rig.driver().stop();
    rig.run(0.5);
    EXPECT_FALSE(rig.driver().moving());
    expectNear(rig.read(), rig.place(), TypeParam::kTold);
  }
  EXPECT_EQ(rig.driver().malformed(), 0);
  EXPECT_EQ(rig.driver().state(), ManipulatorDevice::State::kReady);
  this->moveAndCheck();
}

TYPED_TEST(SlowAnswersTest, FollowsAsCloselyAsItTells) {
  auto& rig = *this->rig_;
  const Eigen::Vector3d velocity(0.1e-3, -0.05e-3, 0.02e-3);
  Eigen::Vector3d goal = rig.place();
  double lag = 0;
  rig.run(3.0, [&] {
    goal += velocity * 1e-3;
    rig.driver().follow(goal, velocity);
    if (rig.time() > 2) lag = std::max(lag, (goal - rig.place()).norm());
  });
  const ManipulatorAbilities abilities = rig.driver().abilities();
  EXPECT_LT(lag, velocity.norm() * (abilities.latency + abilities.command_interval) + TypeParam::kStep);
}

}  // namespace
}  // namespace microinjection
