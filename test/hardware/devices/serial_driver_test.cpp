// What every driver of a serial micromanipulator keeps to; a new one adds its name to the list.

#include <utility>

#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

template <typename Tested>
class SerialDriverTest : public DriverTest<Tested> {
 public:
  using TestedType = Tested;
  using DriverTest<Tested>::make;
  using DriverTest<Tested>::start;
  using DriverTest<Tested>::moveAndCheck;
  using DriverTest<Tested>::rig_;
};

TYPED_TEST_SUITE(SerialDriverTest, AllTested, Names);

/// A rig's node sends moves to a device that does not follow, and set-points to both kinds.
template <typename Rig>
std::function<void()> towards(Rig& rig, const Eigen::Vector3d& place, double speed, bool follows) {
  if (follows) return [&rig, place] { rig.driver().follow(place, Eigen::Vector3d::Zero()); };
  rig.driver().moveTo(place, speed);
  return [] {};
}

template <typename Test>
void checkStops(Test& test, bool follows) {
  using Tested = typename Test::TestedType;
  test.make();
  test.start();
  auto& rig = *test.rig_;
  rig.run(0.5, towards(rig, kPlace + Eigen::Vector3d(5e-3, 0, 0), Tested::kFastest, follows));
  ASSERT_TRUE(rig.runUntil([&] { return rig.device().moves(); }, 0.2));
  const double from = rig.time();
  rig.driver().stop();
  ASSERT_TRUE(rig.runUntil([&] { return !rig.device().moves(); }, 1));
  EXPECT_LT(rig.time() - from, 0.05 + Tested::kStopOnWire);
  EXPECT_LT(rig.time() - from, rig.driver().abilities().stop_time + 2e-3);
  rig.run(0.3);
  EXPECT_FALSE(rig.driver().moving());
  expectNear(rig.read(), rig.place(), Tested::kTold);
  test.moveAndCheck();
}

TYPED_TEST(SerialDriverTest, StopsAMoveWithinFiftyMillisecondsAndTheWire) { checkStops(*this, false); }
TYPED_TEST(SerialDriverTest, StopsWhileItFollowsWithinFiftyMillisecondsAndTheWire) { checkStops(*this, true); }

template <typename Test>
void checkLongSilence(Test& test, bool follows) {
  using Tested = typename Test::TestedType;
  test.make();
  test.start();
  auto& rig = *test.rig_;
  const auto command = towards(rig, kPlace, 0.2e-3, follows);
  rig.inject("silence:8");
  double waited = 0;  // s
  for (; rig.driver().state() != ManipulatorDevice::State::kFault && waited < 7; waited += 1e-3) rig.run(1e-3, command);
  ASSERT_LT(waited, 7);
  EXPECT_NE(rig.driver().reason().find("no reply"), std::string::npos) << rig.driver().reason();
  EXPECT_FALSE(rig.driver().reading());     // nobody knows where a device is that does not answer
  rig.run(8, follows ? command : nullptr);  // a stream that goes on moves nothing
  expectNear(rig.read(), rig.place(), Tested::kTold);
  EXPECT_EQ(rig.driver().state(), ManipulatorDevice::State::kFault);  // latched
  EXPECT_FALSE(rig.device().moves());                                 // the stop was said again until it was heard
  rig.driver().clearFault();
  ASSERT_TRUE(rig.runUntilReady());
  rig.run(0.5);
  EXPECT_FALSE(rig.device().moves());  // rests until the next command
  test.moveAndCheck();
}

TYPED_TEST(SerialDriverTest, LongSilenceOfAMoveIsAFaultThatCanBeCleared) { checkLongSilence(*this, false); }
TYPED_TEST(SerialDriverTest, LongSilenceWhileItFollowsIsAFaultThatCanBeCleared) { checkLongSilence(*this, true); }

TYPED_TEST(SerialDriverTest, AHandWheelIsNotWorkedAgainst) {
  for (const bool follows : {false, true}) {
    SCOPED_TRACE(follows ? "a stream that ended" : "a move");
    this->make();
    this->start();
    auto& rig = *this->rig_;
    if (follows) {
      rig.run(0.3, [&] { rig.driver().follow(kPlace, Eigen::Vector3d::Zero()); });
    } else {
      rig.driver().moveTo(kPlace, 1e-3);
    }
    ASSERT_TRUE(rig.runUntilArrived());
    rig.run(0.5);
    expectNear(rig.place(), kPlace, TypeParam::kStep);
    rig.device().shiftByHand({40e-6, -30e-6, 20e-6});
    const Eigen::Vector3d there = rig.place();
    bool moved = false;
    rig.run(3, [&] { moved = moved || rig.device().moves(); });
    EXPECT_FALSE(moved);
    expectNear(rig.place(), there, 0);
    if (!TypeParam::kMovedByHand) {  // nobody can have moved it: its coordinates began anew
      EXPECT_EQ(rig.driver().state(), ManipulatorDevice::State::kFault);
      EXPECT_FALSE(rig.driver().reading());
      rig.driver().clearFault();
      ASSERT_TRUE(rig.runUntilReady()) << rig.driver().reason();
    }
    expectNear(rig.read(), there, TypeParam::kTold);  // but it is seen
    EXPECT_FALSE(rig.driver().moving());
  }
}

TYPED_TEST(SerialDriverTest, ConnectsAgainByItselfAndRests) {
  this->start();
  auto& rig = *this->rig_;
  rig.driver().moveTo(kPlace + Eigen::Vector3d(5e-3, 0, 0), 1e-3);
  rig.run(0.2);
  rig.wire().disconnectCable();
  rig.run(1);
  EXPECT_EQ(rig.driver().state(), ManipulatorDevice::State::kDisconnected);
  EXPECT_FALSE(rig.driver().reading());
  EXPECT_NE(rig.driver().reason().find("pulled"), std::string::npos) << rig.driver().reason();
  rig.wire().connectCable();
  ASSERT_TRUE(rig.runUntilReady());
  EXPECT_FALSE(rig.device().moves());  // the first thing it heard was a stop
  EXPECT_LT(rig.place().x(), 4e-3);
  expectNear(rig.read(), rig.place(), TypeParam::kTold);
  const Eigen::Vector3d there = rig.place();
  rig.run(0.5);
  expectNear(rig.place(), there, 0);
  this->moveAndCheck();
}

/// What the device has to say comes late by the time in which nobody listened: no fault of the device's.
TYPED_TEST(SerialDriverTest, AMachineThatStallsMissesNoAnswer) {
  for (const double stall : {1.0, 3.0}) {  // s: longer than an answer may take, and than a line may be noisy
    SCOPED_TRACE(stall);
    this->make();
    auto& rig = *this->rig_;
    const auto failed = [&] { return rig.driver().state() == ManipulatorDevice::State::kFault; };
    const auto ready = [&] { return rig.driver().state() == ManipulatorDevice::State::kReady; };
    const auto run_until = [&](const std::function<bool()>& done) {
      for (int i = 0; i < 400 && !done() && !failed(); ++i) {
        rig.run(0.03);
        rig.stall(stall);
      }
      return done();
    };
    ASSERT_TRUE(run_until(ready)) << rig.driver().reason();
    rig.driver().moveTo(kPlace, 1e-3);
    ASSERT_TRUE(run_until([&] { return ready() && !rig.driver().moving(); })) << rig.driver().reason();
    expectNear(rig.place(), kPlace, TypeParam::kStep);
    expectNear(rig.read(), rig.place(), TypeParam::kTold);
  }
}

}  // namespace
}  // namespace microinjection
