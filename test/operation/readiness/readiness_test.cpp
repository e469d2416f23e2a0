#include "operation/readiness/readiness.h"

#include <gtest/gtest.h>

#include <utility>

namespace microinjection {
namespace {

using Level = Hindrance::Level;

class ReadinessTest : public testing::Test {
 protected:
  std::string names(double time) const {
    std::string all;
    for (const Hindrance& each : readiness_.hindrances(time)) all += (all.empty() ? "" : ", ") + each.node;
    return all;
  }

  explicit ReadinessTest(std::vector<std::string> nodes = {"micromanipulator", "injection_controller", "haptic_bridge"})
      : readiness_(std::move(nodes), Remedies::builtIn()) {}

  Readiness readiness_;
};

/// Which nodes the session has is not known.
class SomeNodesTest : public ReadinessTest {
 protected:
  SomeNodesTest() : ReadinessTest({}) {}
};

TEST_F(ReadinessTest, IsReadyWhereEveryLoopFollows) {
  EXPECT_FALSE(readiness_.isReady(0)) << "nobody has said anything";
  readiness_.hearLoop("micromanipulator", "", 0);
  readiness_.hearLoop("injection_controller", "", 0);
  EXPECT_FALSE(readiness_.isReady(0)) << "the bridge has not said anything";
  readiness_.hearStatus("haptic_bridge", "cycle", Level::kInformation, "999 Hz", 0);
  EXPECT_FALSE(readiness_.isReady(0)) << "nothing is known of its loop";
  readiness_.hearLoop("haptic_bridge", "", 0);
  readiness_.hearStatus("vision", "images", Level::kWarning, "microscope/image_raw is silent", 0);
  EXPECT_TRUE(readiness_.isReady(1)) << "an image is not needed";
  readiness_.hearStatus("vision", "images", Level::kError, "it hangs", 1);
  EXPECT_FALSE(readiness_.isReady(1));
}

/// A lost rig makes all others complain: it comes first.
TEST_F(ReadinessTest, WhatIsToBeMendedFirstComesFirst) {
  readiness_.hearLoop("haptic_bridge", "no valid needle position", 0);
  readiness_.hearStatus("cell_simulator", "solver", Level::kError, "no valid needle pose", 0);
  readiness_.hearLoop("injection_controller", "no valid force", 0);
  readiness_.hearStatus("micromanipulator", "commands", Level::kError, "Zaber: the line broke; trying again", 0);
  readiness_.hearStatus("notebook", "notebook", Level::kWarning, "the disk is full", 0);
  EXPECT_EQ(names(1), "micromanipulator, cell_simulator, injection_controller, haptic_bridge, notebook");
  const Hindrance first = readiness_.hindrances(1).front();
  EXPECT_EQ(first.section, "The controller is ENABLED, the rig is not");
  EXPECT_NE(first.remedy.find("cable"), std::string::npos) << first.remedy;
  readiness_.hearStatus("notebook", "master", Level::kError, "the ROS master is lost", 1);
  EXPECT_EQ(readiness_.hindrances(1).front().reason, "the ROS master is lost");
}

TEST_F(SomeNodesTest, AStatusThatSaysWhatHoldsIsSaidOnce) {
  readiness_.hearLoop("injection_controller", "no valid force", 0);
  readiness_.hearStatus("injection_controller", "control", Level::kWarning, "held: no valid force", 0);
  ASSERT_EQ(readiness_.hindrances(0).size(), 1U);
  EXPECT_TRUE(readiness_.hindrances(0).front().holds);
  EXPECT_EQ(readiness_.hindrances(0).front().status, "control");
}

/// Nothing is wrong, and nobody asks for a motion: behind what is wrong, and the needle does not follow.
TEST_F(SomeNodesTest, WhatIsNoAlarmComesLast) {
  readiness_.hearLoop("injection_controller", "no injection is under way", 0);
  readiness_.hearStatus("vision", "images", Level::kWarning, "microscope/image_raw is silent", 0);
  EXPECT_EQ(names(0), "vision, injection_controller");
  EXPECT_EQ(readiness_.hindrances(0).back().level, Level::kInformation);
  EXPECT_FALSE(readiness_.isReady(0));
}

TEST_F(ReadinessTest, SilenceIsAReasonAndWhatWasSaidBeforeIsNone) {
  readiness_.hearLoop("micromanipulator", "DISABLED; allowed after enable", 0);
  EXPECT_EQ(names(0), "micromanipulator, injection_controller, haptic_bridge");
  EXPECT_EQ(readiness_.hindrances(0).back().reason, "the node haptic_bridge has not started yet");
  readiness_.hearLoop("injection_controller", "", Readiness::kStart);
  EXPECT_EQ(names(Readiness::kStart + 1), "micromanipulator, haptic_bridge");
  for (const Hindrance& each : readiness_.hindrances(Readiness::kStart + 1)) {
    EXPECT_EQ(each.reason, "the node " + each.node + " is silent");
    EXPECT_EQ(each.level, Level::kError);
    EXPECT_FALSE(each.remedy.empty()) << each.reason;
  }
}

/// A controller that may inject into a cell which nobody holds is not ready.
TEST(HeldCell, HolderAndItsManipulatorBelongToTheSession) {
  Readiness readiness({"micromanipulator", "holder_rig", "injection_controller", "holder"}, Remedies::builtIn());
  const auto hear = [&](double time) {
    for (const char* node : {"micromanipulator", "injection_controller"}) readiness.hearLoop(node, "", time);
    readiness.hearStatus("holder_rig", "commands", Level::kInformation, "holds", time);
  };
  hear(0);
  readiness.hearStatus("holder", "pressure", Level::kInformation, "holds", 0);
  EXPECT_TRUE(readiness.isReady(0));
  hear(1);
  readiness.hearStatus("holder", "pressure", Level::kError,
                       "two nodes command the holder: /a and /b; the pressure is kept; allowed after enable", 1);
  EXPECT_FALSE(readiness.isReady(1));
  EXPECT_NE(readiness.hindrances(1).front().remedy.find("enable to /holder/state_command"), std::string::npos)
      << readiness.hindrances(1).front().remedy;
  hear(10);
  ASSERT_EQ(readiness.hindrances(10).size(), 1U);
  EXPECT_EQ(readiness.hindrances(10).front().reason, "the node holder is silent");
  EXPECT_FALSE(readiness.isReady(10));
}

/// A loop that hangs beside a node that goes on, and a node that came back with other statuses.
TEST_F(ReadinessTest, EachWordHoldsForItsOwnTime) {
  for (const char* node : {"micromanipulator", "injection_controller", "haptic_bridge"})
    readiness_.hearLoop(node, "", 0);
  readiness_.hearStatus("micromanipulator", "rig", Level::kError, "nothing has come; does your node run?", 0);
  for (const double time : {2.0, 4.0}) {
    readiness_.hearStatus("micromanipulator", "cycle", Level::kInformation, "999 Hz", time);
    readiness_.hearLoop("injection_controller", "", time);
    readiness_.hearLoop("haptic_bridge", "", time);
  }
  ASSERT_EQ(readiness_.hindrances(4).size(), 1U);
  EXPECT_EQ(readiness_.hindrances(4).front().reason, "the loop of micromanipulator is silent");
  EXPECT_FALSE(readiness_.hindrances(4).front().remedy.empty());
  EXPECT_FALSE(readiness_.isReady(4));
}

}  // namespace
}  // namespace microinjection
