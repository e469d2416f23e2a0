#include <cmath>
#include <utility>

#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

using Mp285Test = DriverTest<TestedMp285>;

TEST_F(Mp285Test, FastMovesAreCoarseAndEndFine) {
  auto fast = TestedMp285::config();
  fast.speed = 3e-3;
  rig_ = std::make_unique<Rig>(fast, std::make_shared<Mp285Emulator>());
  start();
  const Eigen::Vector3d place(3e-3 + 0.04e-6, 0.12e-6, -1e-3 + 0.08e-6);
  rig_->driver().moveTo(place, 3e-3);
  double fastest = 0;
  Eigen::Vector3d last = rig_->place();
  rig_->run(3, [&] {
    fastest = std::max(fastest, (rig_->place() - last).norm() / 1e-3);
    last = rig_->place();
  });
  expectNear(rig_->place(), place, 0.51 * kStep);
  EXPECT_NEAR(fastest, 3e-3, 0.1e-3);
}

TEST_F(Mp285Test, KnowsTheMicrostepOfAnMp285A) {
  Mp285EmulatorConfig device;
  device.step_div = device.step_mul = 400;
  make(device);
  start();
  rig_->driver().moveTo(kPlace, 0.5e-3);
  ASSERT_TRUE(rig_->runUntilArrived());
  expectNear(rig_->place(), kPlace, 0.51 * kStep);
  EXPECT_DOUBLE_EQ(rig_->driver().abilities().resolution, kStep);
}

TEST_F(Mp285Test, AnUnknownMicrostepIsRefusedWithTheBytesAndMovesNothing) {
  for (const auto& [step_div, step_mul] : {std::pair(16, 4), {400, 4}, {25, 400}, {0, 0}}) {
    SCOPED_TRACE(step_div);
    Mp285EmulatorConfig device;
    device.step_div = step_div;
    device.step_mul = step_mul;
    make(device);
    rig_->run(10, [&] {
      rig_->driver().moveTo(kPlace, 1e-3);
      rig_->driver().clearFault();
      EXPECT_FALSE(rig_->driver().reading());
    });
    EXPECT_EQ(rig_->driver().state(), State::kFault);
    EXPECT_EQ(rig_->device().movesBegun(), 0);
    const std::string why = rig_->driver().reason();
    EXPECT_NE(why.find("STEP_DIV = " + std::to_string(step_div) + " and STEP_MUL = " + std::to_string(step_mul)),
              std::string::npos)
        << why;
    EXPECT_NE(why.find("40 00 02 04 07 00 63"), std::string::npos) << why;
  }
}

TEST_F(Mp285Test, AKeyOverridesTheMicrostepOfEachAxis) {
  auto config = TestedMp285::config();
  config.microsteps << 0.0625e-6, 0.04e-6, 0.03e-6;
  for (const int step_div : {16, 25}) {
    SCOPED_TRACE(step_div);
    Mp285EmulatorConfig device;
    device.step_div = step_div;
    device.microsteps = config.microsteps;
    make(device, config);
    start();
    for (const double speed : {0.1e-3, 1e-3}) {
      const Eigen::Vector3d goal = speed < 0.5e-3 ? kPlace : -kPlace;
      const double from = rig_->time(), way = (goal - rig_->place()).norm();
      double carried = 0;
      Eigen::Vector3d before, told = rig_->read();
      rig_->driver().moveTo(goal, speed);
      ASSERT_TRUE(rig_->runUntil(
          [&] {
            before = std::exchange(told, rig_->read());
            carried = std::max(carried, (told - rig_->place()).norm());
            return rig_->time() > from + 0.05 && !rig_->driver().moving();
          },
          5));
      EXPECT_EQ(told, before) << "the reading at the end corrects nothing";
      expectNear(rig_->place(), goal, 0.51 * 0.0625e-6);
      // Without a known pair nobody knows how fast it is by its own um/s, so only the end is certain.
      if (step_div == 25) EXPECT_LT(carried, 0.02 * way + speed * 4e-3);
    }
  }
}

TEST_F(Mp285Test, AZeroInTheKeyIsTheStatus) {
  auto config = TestedMp285::config();
  config.microsteps << 0, 0, 0.03e-6;
  Mp285EmulatorConfig device;
  device.microsteps << 0.04e-6, 0.04e-6, 0.03e-6;
  make(device, config);
  start();
  moveAndCheck();
  device.step_div = 16;
  make(device, config);
  EXPECT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 3));
}

TEST_F(Mp285Test, LeavesTheDeviceAPauseAfterEachAnswer) {
  Mp285EmulatorConfig device;
  device.answer_time = 1.7e-3;  // s, so that answers come at any time of a step
  make(device);
  ASSERT_TRUE(rig_->runUntilReady(0.7)) << rig_->driver().reason();  // nothing was said twice
  moveAndCheck();
  // A device that needs none is asked sooner; one that needs more would not hear.
  auto hasty = TestedMp285::config();
  hasty.command_pause = 0;
  make({}, hasty);
  EXPECT_FALSE(rig_->runUntilReady(3));
}

TEST_F(Mp285Test, SeveralErrorsAtOnceAreToldAndNoNoise) {
  for (const bool ascii : {true, false}) {
    SCOPED_TRACE(ascii);
    Mp285EmulatorConfig device;
    device.ascii_errors = ascii;
    make(device);
    start();
    const int malformed = rig_->driver().malformed();
    for (int i = 0; i < 3; ++i) {
      rig_->inject("error:6");
      rig_->run(1.2);
    }
    EXPECT_EQ(rig_->driver().malformed(), malformed);
    ASSERT_EQ(rig_->driver().state(), State::kFault);
    EXPECT_EQ(rig_->driver().reason(), "MP-285: its buffer is full, bad command");
    rig_->driver().clearFault();
    ASSERT_TRUE(rig_->runUntilReady());
    rig_->inject("error:9");  // of a move, half way
    moveAndCheck();
    EXPECT_EQ(rig_->device().movesBegun(), 3);  // two parts, one of them in two
    EXPECT_EQ(rig_->driver().malformed(), malformed);
  }
}

TEST_F(Mp285Test, AMoveEndsWhenSeveralExchangesInARowFail) {
  for (const bool locks_up : {false, true}) {
    for (const char* fault : {"drop:4", "deaf:6", "silence:0.7"}) {
      SCOPED_TRACE(fault);
      Mp285EmulatorConfig device;
      device.locks_up = locks_up;
      make(device);
      start();
      rig_->run(0.8 - rig_->time());
      rig_->inject(fault);
      rig_->driver().moveTo(kPlace, 0.2e-3);
      ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kDisconnected; }, 3));
      EXPECT_FALSE(rig_->driver().reading());
      ASSERT_TRUE(rig_->runUntilReady());
      const int moves = rig_->device().movesBegun();
      rig_->run(2);
      EXPECT_EQ(rig_->device().movesBegun(), moves);
      expectNear(rig_->read(), rig_->place(), 0.1 * kStep);
      moveAndCheck();
    }
  }
}

TEST_F(Mp285Test, AMoveWhoseEndWasNotHeardIsNotDoneAgain) {
  start();
  rig_->driver().moveTo(kPlace, 0.2e-3);
  rig_->run(0.05);
  ASSERT_EQ(rig_->device().movesBegun(), 1);
  rig_->inject("drop:1");
  ASSERT_TRUE(rig_->runUntilArrived());
  expectNear(rig_->place(), kPlace, kStep);
  const double parts = std::ceil(kPlace.norm() / 0.2e-3 / TestedMp285::kLongestPart);
  EXPECT_EQ(rig_->device().movesBegun(), parts);
}

}  // namespace
}  // namespace microinjection
