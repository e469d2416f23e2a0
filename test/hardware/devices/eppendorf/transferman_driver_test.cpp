// The TransferMan in microsteps: what its go-tos answer at their end, and how many microsteps a micrometre has.

#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

class TransfermanTest : public DriverTest<TestedTransferman> {};

/// A micrometre is 25.6 microsteps: places between micrometres are reached.
TEST_F(TransfermanTest, RestsBetweenMicrometres) {
  start();
  const double place = 2.34375e-6;  // m, 60 microsteps
  moveAndCheck(TestedTransferman::config().joints.origin + Eigen::Vector3d::Constant(place));
  expectNear(rig_->place(), TestedTransferman::config().joints.origin + Eigen::Vector3d::Constant(place), 1e-12);
}

TEST_F(TransfermanTest, RepliesAtTheEndsOfItsMovesAreNoNoise) {
  start();
  for (int i = 0; i < 20; ++i) {
    rig_->driver().moveTo(kPlace * (i % 2 == 0 ? 0.1 : -0.1), 1e-3);
    rig_->run(0.013 * i);
  }
  EXPECT_EQ(rig_->driver().malformed(), 0);
  moveAndCheck();
}

/// Where it is far enough from its 0, both units are compared.
TEST_F(TransfermanTest, OtherMicrostepsThanTheFilesAreAFault) {
  for (const double microsteps : {25e6, 25.6e6, 16e6}) {
    SCOPED_TRACE(microsteps);
    TransfermanEmulatorConfig device;
    device.microstep = 1 / microsteps;
    make(device);
    rig_->device().shiftByHand({0, -1e-3, 0});
    if (microsteps == 25.6e6) {
      start();
      continue;
    }
    ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 3));
    const std::string why = rig_->driver().reason();
    for (const char* word : {"motor 2", "-1000 um", "microsteps_per_metre"}) {
      EXPECT_NE(why.find(word), std::string::npos) << why;
    }
    rig_->driver().moveTo(kPlace, 1e-3);
    rig_->run(1);
    EXPECT_EQ(rig_->device().movesBegun(), 0);
  }
}

}  // namespace
}  // namespace microinjection
