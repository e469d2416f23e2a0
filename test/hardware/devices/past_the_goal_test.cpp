// A device that hears of a move's end late must not go past it: there may be the dish.

#include <gtest/gtest.h>

#include "../manipulator/rig_file.h"
#include "hardware/devices/needle_loop.h"
#include "hardware/devices/zaber/zaber_driver.h"
#include "hardware/devices/zaber/zaber_emulator.h"
#include "hardware/manipulator/micromanipulator.h"
#include "hardware/serial/emulated_wire.h"

namespace microinjection {
namespace {

/// How far (m) below its goal, `drop` (m) under the start, the needle truly gets.
double pastTheGoal(double drop) {
  ZaberConfig config;
  config.joints.origin.setConstant(-12.5e-3);
  const auto device = std::make_shared<ZaberEmulator>();
  ZaberDriver driver(config, std::make_unique<EmulatedWire>(device, config.port.baud));
  const auto geometry = ManipulatorGeometry::fromUrdf(rigUrdf(), 0);
  Micromanipulator needle(geometry, CollisionGuard(rigUrdf(), geometry, kMargin), {}, driver);
  double time = 0, lowest = 1;  // s, m
  const auto truth = [&] { return geometry.tip(config.joints.toJoints(device->position())).z(); };
  const auto goTo = [&](double z) {
    Eigen::Isometry3d pose = geometry.tip_at_zero;
    pose.translation() = Eigen::Vector3d(0.3e-3, 0, z);
    EXPECT_EQ(needle.movePosition(pose), "");
    lowest = 1;
    for (int i = 0; i < 5000; ++i) {
      needle.step(time += kStep, kStep);
      lowest = std::min(lowest, truth());
    }
    EXPECT_NEAR(truth(), z, 0.1e-6);
  };
  for (int i = 0; i < 1000; ++i) needle.step(time += kStep, kStep);
  goTo(drop);
  goTo(0);
  return -lowest;
}

TEST(PastTheGoal, AFastMoveOfAZaberStaysWithinTheCollisionMargin) {
  // The end falls on other places of the driver's turn each time.
  for (int i = 0; i < 12; ++i) EXPECT_LT(pastTheGoal(0.6e-3 + i * 7.3e-6), kMargin) << i;
}

}  // namespace
}  // namespace microinjection
