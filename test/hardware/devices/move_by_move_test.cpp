// What every driver of a device keeps to that goes from one move to the next.

#include <algorithm>
#include <cmath>

#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

template <typename Tested>
using MoveByMoveTest = DriverTest<Tested>;
TYPED_TEST_SUITE(MoveByMoveTest, AllMoveByMove, Names);

TYPED_TEST(MoveByMoveTest, MovesToAPlaceAtItsSpeed) {
  this->start();
  auto& rig = *this->rig_;
  for (const double speed : {0.2e-3, 1e-3}) {
    const Eigen::Vector3d goal = speed < 0.5e-3 ? kPlace : -3 * kPlace;
    const double way = (goal - rig.place()).norm(), from = rig.time();
    const int moves = rig.device().movesBegun();
    double off = 0;
    rig.driver().moveTo(goal, speed);
    ASSERT_TRUE(rig.runUntil(
        [&] {
          off = std::max(off, (rig.read() - rig.place()).norm());
          return rig.time() > from + 0.1 && !rig.driver().moving();
        },
        3));
    expectNear(rig.place(), goal, TypeParam::kStep);
    const double parts = std::max(1.0, std::ceil(way / speed / TypeParam::kLongestPart));
    EXPECT_EQ(rig.device().movesBegun(), moves + parts);
    EXPECT_GT(rig.time() - from, way / speed);
    EXPECT_LT(rig.time() - from, (1 + TypeParam::kSlower) * way / speed + (parts - 1) * TypeParam::kPause +
                                     TypeParam::kRamp * speed + rig.driver().abilities().latency + 0.02);
    EXPECT_LT(off, TypeParam::offUnderWay(speed));
  }
}

TYPED_TEST(MoveByMoveTest, TakesSetPointsAsShortMovesTheNewestWins) {
  this->start();  // emulators take no move while another is under way: they refuse it, or do not answer
  auto& rig = *this->rig_;
  const Eigen::Vector3d velocity(0.1e-3, -0.05e-3, 0.02e-3);
  Eigen::Vector3d goal = rig.place();
  double lag = 0;
  rig.run(2.0, [&] {
    goal += velocity * 1e-3;
    rig.driver().follow(goal, velocity);
    if (rig.time() > 1) lag = std::max(lag, (goal - rig.place()).norm());
  });
  const ManipulatorAbilities abilities = rig.driver().abilities();
  EXPECT_LT(lag, velocity.norm() * (abilities.latency + abilities.command_interval));
  rig.driver().follow(goal, Eigen::Vector3d::Zero());
  ASSERT_TRUE(rig.runUntilArrived());
  expectNear(rig.place(), goal, TypeParam::kStep);
  const int moves = rig.device().movesBegun();
  EXPECT_GT(moves, 2.0 / abilities.command_interval / 2);
  EXPECT_LT(moves, 2.0 / abilities.command_interval * TypeParam::kMostMoves);
  rig.run(1);
  EXPECT_EQ(rig.device().movesBegun(), moves);  // nothing is done twice
  for (int i = 0; i < 20; ++i) {
    rig.driver().moveTo(kPlace * (i % 2 == 0 ? 5 : -5), 1e-3);
    rig.run(0.11 + 0.013 * i);
  }
  EXPECT_EQ(rig.driver().malformed(), 0);
  EXPECT_EQ(rig.driver().state(), ManipulatorDevice::State::kReady);
  this->moveAndCheck();
}

TYPED_TEST(MoveByMoveTest, ANewCommandBreaksOffALongMove) {
  this->start();
  auto& rig = *this->rig_;
  rig.driver().moveTo(kPlace + Eigen::Vector3d(5e-3, 0, 0), 1e-3);
  rig.run(0.3);
  ASSERT_TRUE(rig.device().moves());
  const double far = rig.place().x();
  this->moveAndCheck(kPlace);
  EXPECT_LT(far, 1e-3);
  if (!TypeParam::kInParts) EXPECT_EQ(rig.device().movesBegun(), 2);
}

TYPED_TEST(MoveByMoveTest, RecoversFromFaultsOfTheLineAndLosesNoMove) {
  for (const auto& device : TypeParam::devices()) {
    for (const std::string& fault : TypeParam::faults()) {
      SCOPED_TRACE(fault);
      this->make(device);
      this->start();
      auto& rig = *this->rig_;
      rig.run(0.8 - rig.time());
      rig.inject(fault);
      rig.driver().moveTo(kPlace, 0.2e-3);
      ASSERT_TRUE(rig.runUntilArrived()) << rig.driver().reason();
      expectNear(rig.place(), kPlace, TypeParam::kStep);
      expectNear(rig.read(), rig.place(), TypeParam::kTold);
      if (!TypeParam::kInParts) EXPECT_LE(rig.device().movesBegun(), TypeParam::kMovesAtMost);
    }
  }
}

TYPED_TEST(MoveByMoveTest, AMoveThatIsInterruptedTwiceIsAFault) {
  this->start();
  auto& rig = *this->rig_;
  rig.driver().moveTo(kPlace, 0.1e-3);
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(rig.runUntil([&] { return rig.device().moves(); }, TypeParam::kEndIsSeen));
    rig.run(std::min(0.1, 0.5 * TypeParam::kLongestPart));
    rig.inject("interrupt");
    rig.run(2e-3);
  }
  ASSERT_TRUE(rig.runUntil([&] { return rig.driver().state() == ManipulatorDevice::State::kFault; },
                           1 + TypeParam::kEndIsSeen));
  EXPECT_NE(rig.driver().reason().find("interrupted"), std::string::npos) << rig.driver().reason();
  rig.driver().clearFault();
  ASSERT_TRUE(rig.runUntilReady());
  this->moveAndCheck();
}

TYPED_TEST(MoveByMoveTest, ASlowMachineMovesIt) {
  for (const double step : {0.03, 0.06, 0.12}) {
    SCOPED_TRACE(step);
    EmulatedRig<typename TypeParam::Driver, typename TypeParam::Config> rig(
        TypeParam::config(), std::make_shared<typename TypeParam::Emulator>(), step);
    ASSERT_TRUE(rig.runUntilReady(30)) << rig.driver().reason();
    rig.driver().moveTo(kPlace, 1e-3);
    ASSERT_TRUE(rig.runUntilArrived(30)) << rig.driver().reason();
    expectNear(rig.read(), kPlace, TypeParam::kStep);
  }
}

}  // namespace
}  // namespace microinjection
