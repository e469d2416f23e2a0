// What every driver of a serial micromanipulator keeps to; a new one adds its name to the list.

#include <utility>

#include "rigs/driver_fixture.h"

namespace microinjection {
namespace {

template <typename Tested>
class SerialDriverTest : public DriverTest<Tested> {};

struct Names {
  template <typename Tested>
  static std::string GetName(int) {
    return std::is_same_v<Tested, TestedZaber> ? "zaber" : "mp285";
  }
};
using AllTested = testing::Types<TestedZaber, TestedMp285>;
TYPED_TEST_SUITE(SerialDriverTest, AllTested, Names);

TYPED_TEST(SerialDriverTest, StopsWithinFiftyMillisecondsAndTheWire) {
  this->start();
  auto& rig = *this->rig_;
  rig.driver().moveTo(kPlace + Eigen::Vector3d(5e-3, 0, 0), TypeParam::kFastest);
  rig.run(0.5);
  ASSERT_TRUE(rig.device().moves());
  const double from = rig.time();
  rig.driver().stop();
  ASSERT_TRUE(rig.runUntil([&] { return !rig.device().moves(); }, 1));
  EXPECT_LT(rig.time() - from, 0.05 + TypeParam::kStopOnWire);
  EXPECT_LT(rig.time() - from, rig.driver().abilities().stop_time + 2e-3);
  rig.run(0.3);
  EXPECT_FALSE(rig.driver().moving());
  expectNear(rig.read(), rig.place(), 0.1 * TypeParam::kStep);
  this->moveAndCheck();
}

TYPED_TEST(SerialDriverTest, LongSilenceIsAFaultThatCanBeCleared) {
  this->start();
  auto& rig = *this->rig_;
  rig.driver().moveTo(kPlace, 0.2e-3);
  rig.inject("silence:8");
  ASSERT_TRUE(rig.runUntil([&] { return rig.driver().state() == ManipulatorDevice::State::kFault; }, 7));
  EXPECT_NE(rig.driver().why().find("no answer"), std::string::npos) << rig.driver().why();
  EXPECT_FALSE(rig.driver().reading());  // nobody knows where a device is that does not answer
  rig.run(8);
  expectNear(rig.read(), rig.place(), 0.1 * TypeParam::kStep);
  EXPECT_EQ(rig.driver().state(), ManipulatorDevice::State::kFault);  // latched
  EXPECT_FALSE(rig.device().moves());                                 // the stop was said again until it was heard
  rig.driver().clearFault();
  ASSERT_TRUE(rig.runUntilReady());
  rig.run(0.5);
  EXPECT_FALSE(rig.device().moves());  // rests until the next command
  this->moveAndCheck();
}

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
    expectNear(rig.read(), there, 0.1 * TypeParam::kStep);  // but it is seen
    EXPECT_FALSE(rig.driver().moving());
  }
}

TYPED_TEST(SerialDriverTest, ConnectsAgainByItselfAndRests) {
  this->start();
  auto& rig = *this->rig_;
  rig.driver().moveTo(kPlace + Eigen::Vector3d(5e-3, 0, 0), 1e-3);
  rig.run(0.2);
  rig.wire().pull();
  rig.run(1);
  EXPECT_EQ(rig.driver().state(), ManipulatorDevice::State::kDisconnected);
  EXPECT_FALSE(rig.driver().reading());
  EXPECT_NE(rig.driver().why().find("pulled"), std::string::npos) << rig.driver().why();
  rig.wire().plug();
  ASSERT_TRUE(rig.runUntilReady());
  EXPECT_FALSE(rig.device().moves());  // the first thing it heard was a stop
  EXPECT_LT(rig.place().x(), 4e-3);
  expectNear(rig.read(), rig.place(), 0.1 * TypeParam::kStep);
  const Eigen::Vector3d there = rig.place();
  rig.run(0.5);
  expectNear(rig.place(), there, 0);
  this->moveAndCheck();
}

}  // namespace
}  // namespace microinjection
