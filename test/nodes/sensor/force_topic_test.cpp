// A wrench of another node: it arrives at the tip, in its axes and about its centre; what tf cannot place is not valid.

#include <gtest/gtest.h>
#include <std_srvs/Trigger.h>
#include <tf2_msgs/TFMessage.h>

#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "nodes/runtime/conversions.h"
#include "virtual_session.h"

namespace microinjection {
namespace {

class ForceTopic : public testing::Test {
 protected:
  using Wrench = geometry_msgs::WrenchStamped;

  ForceTopic() {
    // 10 mm behind the tip, its z axis is the tip's x axis.
    geometry_msgs::TransformStamped transducer;
    transducer.header.frame_id = "needle_tip";
    transducer.child_frame_id = "transducer";
    transducer.transform.translation.z = 0.01;
    transducer.transform.rotation.y = transducer.transform.rotation.w = std::sqrt(0.5);
    tf2_msgs::TFMessage frames;
    frames.transforms = {transducer};
    session_.world().say("/tf_static", frames, true);
    session_.world().repeat<Wrench>("force_sensor/device_cf", [this] { return wrench_; });
    session_.add("force_sensor", "{diagnostic_period: 0.1}");
    session_.run(0.02);
  }
  static Wrench wrench(double x, double y, double z) {
    Wrench message = wrenchMessage(x, y, z, "transducer");
    message.wrench.torque.y = 5e-8;
    return message;
  }
  const Wrench& measured() { return *probe_.newest(); }
  Eigen::Vector3d force() { return toVector(measured().wrench.force); }
  Eigen::Vector3d torque() { return toVector(measured().wrench.torque); }

  // The test's wrench has no noise.
  VirtualSession session_{{"sensor.source:=topic", "sensor.quiet:=true"}};
  const Probe<Wrench>& probe_ = session_.world().hear<Wrench>("force_sensor/measured_cf");
  std::optional<Wrench> wrench_ = wrench(1e-6, 2e-6, 3e-6);
};

TEST_F(ForceTopic, ForceAndTorqueAreThoseAtTheTip) {
  EXPECT_EQ(measured().header.frame_id, "needle_tip");
  // The transducer's x is the tip's -z, its y the tip's y, its z the tip's x.
  EXPECT_LT((force() - Eigen::Vector3d(3e-6, 2e-6, -1e-6)).norm(), 1e-15);
  // Arm x force = (-0.01 x 2e-6, 0.01 x 3e-6, 0).
  EXPECT_LT((torque() - Eigen::Vector3d(-2e-8, 5e-8 + 3e-8, 0)).norm(), 1e-15);
}

TEST_F(ForceTopic, TareTakesOffForceAndTorque) {
  const auto answer = session_.call<std_srvs::Trigger>("force_sensor/tare");
  ASSERT_TRUE(answer.success) << answer.message;
  session_.run(0.6);
  EXPECT_LT(force().norm(), 1e-12);
  EXPECT_LT(torque().norm(), 1e-14);
  wrench_ = wrench(2e-6, 2e-6, 3e-6);
  session_.run(0.02);
  EXPECT_LT((force() - Eigen::Vector3d(0, 0, -1e-6)).norm(), 1e-12);
}

TEST_F(ForceTopic, WhatCannotBePlacedOrReadIsNotTrusted) {
  Wrench twisted = wrench(1e-6, 0, 0);
  twisted.wrench.torque.y = NAN;
  const std::pair<std::optional<Wrench>, std::string> untrusted[] = {
      {twisted, "no valid wrench"},
      {wrenchMessage(1e-6, 0, 0, "nowhere"), "no transform from frame 'nowhere'"},
      {wrenchMessage(NAN, 0, 0, "transducer"), "no valid wrench"},
      {std::nullopt, "no valid wrench"}};
  for (const auto& [bad, why] : untrusted) {
    SCOPED_TRACE(why);
    wrench_ = wrench(0, 0, 0);
    session_.run(0.02);
    EXPECT_FALSE(measured().header.stamp.isZero());
    wrench_ = bad;
    session_.run(0.3);
    EXPECT_NE(session_.diagnostics().text("force_sensor: sensor").find(why), std::string::npos)
        << session_.diagnostics().text("force_sensor: sensor");
    EXPECT_TRUE(measured().header.stamp.isZero());
  }
}

}  // namespace
}  // namespace microinjection
