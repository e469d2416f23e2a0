// The PatchMan takes whole micrometres a second for each axis. A move is not faster than it was commanded for that, and
// keeps to its line.

#include <algorithm>

#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

class EppendorfSpeedTest : public DriverTest<TestedEppendorf> {
 protected:
  /// How far (m) the needle gets from the line, and past where it should be by now.
  void move(const Eigen::Vector3d& way, double speed) {
    rig_.reset();
    start();
    const Eigen::Vector3d from = rig_->place(), along = way.normalized();
    const double begin = rig_->time();
    aside_ = ahead_ = 0;
    rig_->driver().moveTo(from + way, speed);
    ASSERT_TRUE(rig_->runUntil(
        [&] {
          const Eigen::Vector3d gone = rig_->place() - from;
          aside_ = std::max(aside_, (gone - along * along.dot(gone)).norm());
          ahead_ = std::max(ahead_, along.dot(gone) - speed * (rig_->time() - begin));
          return rig_->time() > begin + 0.5 && !rig_->driver().moving();
        },
        4 * way.norm() / speed));
    expectNear(rig_->place(), from + way, 1e-9);
    share_ = (rig_->time() - begin) / (way.norm() / speed);
  }
  double aside_ = 0, ahead_ = 0;  // m
  double share_ = 0;              // of the time that was commanded
};

TEST_F(EppendorfSpeedTest, ASlowMoveIsAsSlowAsItWasCommanded) {
  for (const double speed : {0.3e-6, 0.7e-6, 1e-6, 1.5e-6, 2e-6, 3.3e-6}) {
    for (const Eigen::Vector3d& way : {Eigen::Vector3d(6e-6, -6e-6, 6e-6), {0, 9e-6, 1e-6}, {0, 0, 8e-6}}) {
      SCOPED_TRACE(testing::Message() << speed << " m/s, " << way.transpose());
      ASSERT_NO_FATAL_FAILURE(move(way, speed));
      EXPECT_LT(ahead_, 2.1e-6);  // a step
      EXPECT_LT(aside_, 1.01e-6);
      EXPECT_GT(share_, 1 - 2.1e-6 / way.norm());  // it waits behind a step, but not behind the last one
      EXPECT_LT(share_, 1.6);
    }
  }
}

TEST_F(EppendorfSpeedTest, ALongMoveKeepsToItsLine) {
  for (const double speed : {5e-6, 20e-6, 200e-6}) {
    for (const Eigen::Vector3d& way :
         {Eigen::Vector3d(400e-6, 210e-6, 0), {300e-6, 3e-6, -40e-6}, {-111e-6, 222e-6, 77e-6}}) {
      SCOPED_TRACE(testing::Message() << speed << " m/s, " << way.transpose());
      ASSERT_NO_FATAL_FAILURE(move(way, speed));
      EXPECT_LT(ahead_, 1e-6);
      EXPECT_LT(aside_, 1.87e-6);  // a count, beside places that are rounded
      EXPECT_GT(share_, 0.99);
      EXPECT_LT(share_, 1.35);
    }
  }
}

}  // namespace
}  // namespace microinjection
