#include "operation/readiness/readiness.h"

#include <gtest/gtest.h>

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

  Readiness readiness_{{"micromanipulator", "injection_controller", "haptic_bridge"}, Remedies::builtIn()};
};

TEST_F(ReadinessTest, IsReadyWhereEveryLoopFollows) {
  EXPECT_FALSE(readiness_.isReady(0)) << "nobody has said anything";
  readiness_.hearLoop("micromanipulator", "", 0);
  readiness_.hearLoop("injection_controller", "", 0);
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

TEST_F(ReadinessTest, AStatusThatSaysWhatHoldsIsSaidOnce) {
  readiness_.hearLoop("injection_controller", "no valid force", 0);
  readiness_.hearStatus("injection_controller", "control", Level::kWarning, "held: no valid force", 0);
  ASSERT_EQ(readiness_.hindrances(0).size(), 1U);
  EXPECT_TRUE(readiness_.hindrances(0).front().holds);
  EXPECT_EQ(readiness_.hindrances(0).front().status, "control");
}

/// Nothing is wrong, and nobody asks for a motion: behind what is wrong, and the needle does not follow.
TEST_F(ReadinessTest, WhatIsNoAlarmComesLast) {
  readiness_.hearLoop("injection_controller", "no injection is under way", 0);
  readiness_.hearStatus("vision", "images", Level::kWarning, "microscope/image_raw is silent", 0);
  EXPECT_EQ(names(0), "vision, injection_controller");
  EXPECT_EQ(readiness_.hindrances(0).back().level, Level::kInformation);
  EXPECT_FALSE(readiness_.isReady(0));
}

TEST_F(ReadinessTest, SilenceIsAReasonAndWhatWasSaidBeforeIsNone) {
  readiness_.hearLoop("micromanipulator", "DISABLED; allowed after enable", 0);
  EXPECT_EQ(names(Readiness::kSilence), "micromanipulator");
  readiness_.hearLoop("injection_controller", "", 3);
  EXPECT_EQ(names(Readiness::kSilence + 1), "micromanipulator, haptic_bridge");
  for (const Hindrance& each : readiness_.hindrances(Readiness::kSilence + 1)) {
    EXPECT_EQ(each.reason, each.node + " is silent");
    EXPECT_EQ(each.level, Level::kError);
    EXPECT_FALSE(each.remedy.empty()) << each.reason;
  }
}

}  // namespace
}  // namespace microinjection
