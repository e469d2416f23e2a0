// What rviz tells of the dragged handle, at x 1e4, moves the hand at a limited speed while the mouse button is down.

#include <gtest/gtest.h>
#include <visualization_msgs/InteractiveMarkerFeedback.h>
#include <visualization_msgs/InteractiveMarkerInit.h>
#include <visualization_msgs/InteractiveMarkerUpdate.h>

#include "cell_microinjection/OperatingState.h"
#include "haptic_world.h"

namespace microinjection {
namespace {

using Feedback = visualization_msgs::InteractiveMarkerFeedback;
using visualization_msgs::InteractiveMarkerInit;
using visualization_msgs::InteractiveMarkerUpdate;
const Eigen::Vector3d kMarkerTip(1e-6, 2e-6, 30e-6);                                // m
const Eigen::Vector3d kHandle = 1e4 * (kMarkerTip + Eigen::Vector3d(36e-6, 0, 0));  // display units
constexpr double kHandSpeed = 0.01;                                                 // m/s, config/haptic/marker.yaml

class MarkerTest : public testing::Test {
 protected:
  MarkerTest() {
    device_.driver().hear<InteractiveMarkerInit>("hand_marker/update_full");
    device_.driver().hear<InteractiveMarkerUpdate>("hand_marker/update");
    needle();
    target();
    device_.run(0.2);
    EXPECT_FALSE(present());
  }

  void needle() { repeatTip("needle/measured_cp"); }
  /// The bridge leads the needle.
  void target() { repeatTip("teleop/servo_cp"); }
  /// The bridge holds the needle.
  void hold() { device_.driver().repeatInvalid<geometry_msgs::PoseStamped>("teleop/servo_cp"); }
  void tell(std::uint8_t event, const Eigen::Vector3d& place = kHandle, const std::string& frame = "viz/world",
            std::uint32_t entry = 0, const std::string& client = "test") {
    Feedback message;
    message.header.frame_id = frame;
    message.client_id = client;
    message.marker_name = "hand";
    message.event_type = event;
    message.menu_entry_id = entry;
    message.pose = poseMessage(place.x(), place.y(), place.z()).pose;
    device_.driver().say("hand_marker/feedback", message);
  }
  void controller(const std::string& state, bool busy = false) {
    cell_microinjection::OperatingState message;
    message.state = state;
    message.is_busy = busy;
    device_.driver().sayNow("controller/operating_state", message);
  }

  /// The handle is taken hold of and dragged along z by `way` (m); the hand is on its way. @returns where it was
  Eigen::Vector3d drag(double way = -4e-6) {
    const Eigen::Vector3d start = device_.hand();
    place_ = kHandle + Eigen::Vector3d(0, 0, 1e4 * way);
    tell(Feedback::MOUSE_DOWN);
    tell(Feedback::POSE_UPDATE, place_);
    device_.run(0.02);
    EXPECT_TRUE(present());
    EXPECT_NE(device_.hand(), start);
    return start;
  }
  void letGo() {
    tell(Feedback::MOUSE_UP);
    device_.run(0.02);
    EXPECT_FALSE(present());
  }
  /// With rviz telling that the mouse button is down.
  void goOn(double seconds) {
    for (int i = 0; i < std::lround(10 * seconds); ++i) {
      tell(Feedback::KEEP_ALIVE, place_);
      device_.run(0.1);
    }
  }

  bool present() { return device_.buttons().second == 1; }
  /// Where rviz shows the handle.
  Eigen::Vector3d shown() {
    const auto& updates = device_.driver().hear<InteractiveMarkerUpdate>("hand_marker/update").all();
    for (auto update = updates.rbegin(); update != updates.rend(); ++update) {
      if (!(*update)->poses.empty()) return toVector((*update)->poses[0].pose.position);
    }
    return Eigen::Vector3d::Constant(NAN);
  }
  const visualization_msgs::InteractiveMarker& marker() {
    return device_.driver().hear<InteractiveMarkerInit>("hand_marker/update_full").newest()->markers.at(0);
  }

  HapticWorld device_{{"hand.device:=marker"}};
  Eigen::Vector3d place_ = kHandle;  ///< of the handle as rviz drags it

 private:
  void repeatTip(const std::string& topic) {
    device_.driver().repeat(topic, poseMessage(kMarkerTip.x(), kMarkerTip.y(), kMarkerTip.z()));
  }
};

TEST_F(MarkerTest, TheHandleGoesWithTheNeedle) {
  EXPECT_LT((shown() - kHandle).norm(), 1e-3);
  EXPECT_EQ(marker().header.frame_id, "viz/world");
}

TEST_F(MarkerTest, ADragMovesTheHandAtALimitedSpeed) {
  const Eigen::Vector3d start = device_.hand();
  tell(Feedback::MOUSE_DOWN);
  device_.run(0.02);
  EXPECT_TRUE(present());
  EXPECT_LT((device_.hand() - start).norm(), 1e-12);
  tell(Feedback::POSE_UPDATE, kHandle + Eigen::Vector3d(0, 0, -4e-2));  // 4 um are 4 mm of the hand
  device_.run(0.1);
  EXPECT_NEAR((device_.hand() - start).norm(), 0.1 * kHandSpeed, 0.01 * kHandSpeed);
  device_.run(0.32);
  EXPECT_LT((device_.hand() - start - Eigen::Vector3d(0, 0, -4e-3)).norm(), 1e-9);
  letGo();
}

/// Of a second window of rviz, while the first one drags.
TEST_F(MarkerTest, ASecondMouseMovesNothing) {
  const Eigen::Vector3d start = drag();
  for (int i = 0; i < 4; ++i) {
    tell(Feedback::KEEP_ALIVE, place_);
    for (const std::uint8_t event : {Feedback::MOUSE_DOWN, Feedback::POSE_UPDATE})
      tell(event, kHandle + Eigen::Vector3d(0.1, 0, 0), "viz/world", 0, "second");
    device_.run(0.1);
  }
  EXPECT_TRUE(present());
  EXPECT_LT((device_.hand() - start - Eigen::Vector3d(0, 0, -4e-3)).norm(), 1e-9);
  letGo();
}

TEST_F(MarkerTest, AHoldOnTheWayIsWaitedFor) {
  const Eigen::Vector3d start = drag();
  device_.run(0.1);
  hold();
  device_.run(0.02);
  const Eigen::Vector3d there = device_.hand();
  goOn(0.3);
  EXPECT_EQ(device_.hand(), there);
  EXPECT_TRUE(present());
  target();
  goOn(0.4);
  EXPECT_LT((device_.hand() - start - Eigen::Vector3d(0, 0, -4e-3)).norm(), 1e-9);
}

TEST_F(MarkerTest, AHandleThatWasDraggedForNothingIsPutBackAndCountsFromWhereItIs) {
  const Eigen::Vector3d start = device_.hand();
  place_ = kHandle + Eigen::Vector3d(0, 0, -0.3);
  tell(Feedback::POSE_UPDATE, place_);  // of a drag that has not begun
  device_.driver().hear<InteractiveMarkerUpdate>("hand_marker/update").clear();
  device_.run(0.2);
  EXPECT_LT((shown() - kHandle).norm(), 1e-3);
  tell(Feedback::MOUSE_DOWN, place_);
  device_.run(0.02);
  EXPECT_TRUE(present());
  goOn(0.4);
  EXPECT_LT((device_.hand() - start).norm(), 1e-9);
}

TEST_F(MarkerTest, AfterALongHoldTheHandleMustBeTakenHoldOfAgain) {
  drag();
  hold();
  goOn(0.9);
  EXPECT_FALSE(present());
  const Eigen::Vector3d there = device_.hand();
  target();
  tell(Feedback::POSE_UPDATE, place_);
  goOn(0.3);
  EXPECT_FALSE(present());
  EXPECT_EQ(device_.hand(), there);
  letGo();
  drag();
}

TEST_F(MarkerTest, AControllerThatDoesNotFollowIsAHold) {
  const std::pair<std::string, bool> states[] = {{"PAUSED", false}, {"ENABLED", true}};
  for (const auto& [state, busy] : states) {
    SCOPED_TRACE(state);
    drag();
    controller(state, busy);
    goOn(1);
    EXPECT_FALSE(present());
    controller("ENABLED");
    device_.run(0.1);
    letGo();
  }
}

TEST_F(MarkerTest, AMouseThatIsSilentIsGone) {
  tell(Feedback::MOUSE_DOWN);
  device_.run(0.5);
  tell(Feedback::KEEP_ALIVE);
  device_.run(0.98);
  EXPECT_TRUE(present());
  device_.run(0.04);
  EXPECT_FALSE(present());
  tell(Feedback::KEEP_ALIVE);
  device_.run(0.02);
  EXPECT_FALSE(present()) << "the handle must be taken hold of again";
}

TEST_F(MarkerTest, AnotherFrameAndWhatIsNoNumberEndTheDrag) {
  const Eigen::Vector3d start = device_.hand();
  const std::pair<Eigen::Vector3d, std::string> bad[] = {{kHandle - Eigen::Vector3d::UnitZ(), "world"},
                                                         {Eigen::Vector3d(NAN, 0, 0), "viz/world"}};
  for (const auto& [place, frame] : bad) {
    SCOPED_TRACE(frame);
    tell(Feedback::MOUSE_DOWN);
    device_.run(0.02);
    EXPECT_TRUE(present());
    tell(Feedback::POSE_UPDATE, place, frame);
    device_.run(0.1);
    EXPECT_FALSE(present());
    EXPECT_EQ(device_.hand(), start);
  }
  tell(Feedback::MENU_SELECT, kHandle, "world", 6);
  device_.run(0.02);
  EXPECT_EQ(device_.commands(), std::vector<std::string>{"disable"});
}

TEST_F(MarkerTest, TheMenuSendsCommands) {
  std::vector<std::string> titles;
  for (const auto& entry : marker().menu_entries) titles.push_back(entry.title);
  EXPECT_EQ(titles, std::vector<std::string>(
                        {"Enable", "Hold the cell", "Inject", "Withdraw (home)", "Release the cell", "Disable"}));
  for (const std::uint32_t entry : {1, 2, 3, 4, 5}) tell(Feedback::MENU_SELECT, kHandle, "viz/world", entry);
  device_.run(0.02);
  EXPECT_EQ(device_.commands(), std::vector<std::string>({"enable", "hold", "inject", "home", "release"}));
}

}  // namespace
}  // namespace microinjection
