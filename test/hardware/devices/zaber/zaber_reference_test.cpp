// An axis without a reference position does not know where it is: nothing moves, and no position is told.

#include <algorithm>

#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

class ZaberReferenceTest : public DriverTest<TestedZaber> {
 protected:
  void expectFault(double within) {
    ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, within));
    EXPECT_NE(rig_->driver().reason().find("reference"), std::string::npos) << rig_->driver().reason();
  }
  /// Nothing is told from here on, whatever is asked.
  void expectNothingTold(double duration) {
    const Eigen::Vector3d there = rig_->place();
    rig_->run(duration, [&] {
      rig_->driver().follow(kPlace, Eigen::Vector3d::Zero());
      EXPECT_FALSE(rig_->driver().reading());
    });
    EXPECT_FALSE(rig_->device().moves());
    expectNear(rig_->place(), there, 0);
  }
};

TEST_F(ZaberReferenceTest, IsMissedBehindAMoreImportantWarning) {
  for (const char* warning : {"WV", "WT", "WP", "WL", "WH", "WM"}) {
    SCOPED_TRACE(warning);
    ZaberEmulatorConfig device;
    device.referenced = false;
    make(device);
    rig_->inject(std::string("error:") + warning);
    expectFault(2);
    expectNothingTold(2);
  }
}

TEST_F(ZaberReferenceTest, WarningsThatHideNothingLetItWork) {
  for (const char* warning : {"WV", "WT", "NC", "NI", "NU"}) {
    SCOPED_TRACE(warning);
    make();
    rig_->inject(std::string("error:") + warning);
    start();
    moveAndCheck();
    EXPECT_EQ(rig_->driver().note().find(warning) != std::string::npos, warning[0] == 'W') << rig_->driver().note();
    rig_->run(2, [&] {
      rig_->driver().follow(kPlace + Eigen::Vector3d(20e-6, 0, 0), Eigen::Vector3d::Zero());
      ASSERT_EQ(rig_->driver().state(), State::kReady) << rig_->driver().reason();
    });
    expectNear(rig_->place(), kPlace + Eigen::Vector3d(20e-6, 0, 0), kStep);
  }
}

/// The axes count from 0 where they stand, which is 12.5 mm from there.
TEST_F(ZaberReferenceTest, ThatIsLostInTheSessionIsAFaultAtOnceAndNoPosition) {
  for (const bool follows : {false, true}) {
    SCOPED_TRACE(follows ? "follows" : "rests");
    make();
    start();
    Eigen::Vector3d goal = rig_->place();
    const auto command = [&] {
      if (follows) rig_->driver().follow(goal += Eigen::Vector3d(0.1e-6, 0, 0), {0.1e-3, 0, 0});
    };
    rig_->run(0.5, command);
    rig_->inject("error:RESET");
    const double from = rig_->time();
    while (rig_->driver().state() != State::kFault && rig_->time() < from + 1) {
      rig_->run(1e-3, command);
      if (rig_->driver().reading()) expectNear(rig_->read(), rig_->place(), 10e-6);
    }
    EXPECT_LE(rig_->time() - from, rig_->driver().abilities().reading_interval);
    EXPECT_NE(rig_->driver().reason().find("reference"), std::string::npos) << rig_->driver().reason();
    expectNothingTold(3);
    rig_->driver().clearFault();
    expectNothingTold(3);
    EXPECT_EQ(rig_->driver().state(), State::kFault);
  }
}

TEST_F(ZaberReferenceTest, ThatIsLostBehindAWarningIsNoticedBeforeAPositionIsTold) {
  for (const bool warned_before : {false, true}) {
    SCOPED_TRACE(warned_before ? "the warning was there before" : "both come at once");
    make();
    start();
    if (warned_before) rig_->inject("error:WT");
    rig_->run(0.5);
    ASSERT_TRUE(rig_->driver().reading());
    rig_->inject("error:RESET");
    rig_->inject("error:WT");
    const double from = rig_->time();
    while (rig_->driver().state() != State::kFault && rig_->time() < from + 1) {
      rig_->run(1e-3);
      if (rig_->driver().reading()) expectNear(rig_->read(), rig_->place(), kStep);
    }
    EXPECT_LE(rig_->time() - from, 3 * rig_->driver().abilities().reading_interval);
    expectNothingTold(2);
  }
}

TEST_F(ZaberReferenceTest, AnAlertOfItIsEnough) {
  ZaberEmulatorConfig device;
  device.alerts = true;
  make(device);
  start();
  rig_->driver().moveTo(kPlace, 1e-3);
  rig_->run(0.02);
  rig_->inject("error:WR");
  expectFault(0.1);
}

TEST_F(ZaberReferenceTest, APositionIsToldAgainWhenThereIsOne) {
  start();
  rig_->inject("error:RESET");
  expectFault(0.1);
  // The maker's tool: each axis is told what it had counted. The joint of axis 3 counts the other way.
  const Eigen::Vector3d place = TestedZaber::config().joints.toDevice(rig_->place());
  for (int i = 0; i < 3; ++i) {
    rig_->device().receive(
        "/1 " + std::to_string(i + 1) + " set pos " + std::to_string(std::lround(place[i] / kStep)) + "\n",
        rig_->time());
  }
  rig_->run(1);
  EXPECT_EQ(rig_->driver().state(), State::kFault);  // latched
  ASSERT_TRUE(rig_->driver().reading());
  expectNear(rig_->read(), rig_->place(), kStep);
  rig_->driver().clearFault();
  ASSERT_TRUE(rig_->runUntilReady());
  moveAndCheck();
}

}  // namespace
}  // namespace microinjection
