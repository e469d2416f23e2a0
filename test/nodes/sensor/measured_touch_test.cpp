#include <gtest/gtest.h>

#include "virtual_session.h"

namespace microinjection {
namespace {

/// Needle, cell and sensor: the sensor measures the cell's force, and nothing when the cell is dead.
TEST(MeasuredTouch, IsTheForceOfTheCell) {
  VirtualSession session({"hand.device:=none"});
  TestNode& world = session.world();
  const auto& predicted = world.hear<geometry_msgs::WrenchStamped>("cell/predicted_cf");
  const auto& measured = world.hear<geometry_msgs::WrenchStamped>("force_sensor/measured_cf");
  for (const char* node : {"micromanipulator", "cell_simulator", "force_sensor"}) session.add(node);
  session.run(0.1);
  world.command("needle/state_command", "enable");
  world.sayNow("needle/move_cp", poseMessage(0, 0, 23e-6));
  session.run(1);
  const double force = predicted.newest()->wrench.force.z;
  EXPECT_GT(force, 0.3e-6);
  EXPECT_NEAR(measured.newest()->wrench.force.z, force, 0.01 * force + 8 * 10e-9);  // gain; noise of 10 nN rms
  session.executive().freeze("cell_simulator");
  session.run(0.1);
  EXPECT_TRUE(measured.newest()->header.stamp.isZero()) << "the newest reading is none";
}

}  // namespace
}  // namespace microinjection
