#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>

#include <cmath>

#include "nodes/bus/local_bus.h"
#include "nodes/bus/local_network.h"
#include "nodes/runtime/cycle.h"
#include "test_node.h"

namespace microinjection {
namespace {

/// Whatever a node computes: what is not finite leaves it as an invalid message, without a number of it.
TEST(OutputTest, WhatIsNotFiniteIsPublishedAsInvalid) {
  for (const double bad : {double(NAN), double(INFINITY)}) {
    LocalNetwork network{ros::Time(10)};
    const auto sender = network.connect("/sender", YAML::Node(YAML::NodeType::Map));
    const auto receiver = network.connect("/receiver", YAML::Node(YAML::NodeType::Map));
    Probe<geometry_msgs::WrenchStamped> heard(*receiver, "force");
    Cycle cycle(*sender, 1000);
    auto& output = cycle.output<geometry_msgs::WrenchStamped>("force");
    geometry_msgs::WrenchStamped force = wrenchMessage(1e-6, 0, 0, "needle_tip");
    force.header.stamp = network.now();
    output.publish(force);
    receiver->run();
    ASSERT_EQ(heard.count(), 1u);
    EXPECT_EQ(heard.newest()->header.stamp, network.now());
    force.wrench.force.z = bad;
    output.publish(force);
    receiver->run();
    ASSERT_EQ(heard.count(), 2u);
    EXPECT_TRUE(heard.newest()->header.stamp.isZero());
    EXPECT_EQ(heard.newest()->header.frame_id, "needle_tip");
    EXPECT_EQ(heard.newest()->wrench.force.z, 0);
    EXPECT_EQ(output.withheld, 1u);
  }
}

}  // namespace
}  // namespace microinjection
