#include <actionlib_msgs/GoalStatus.h>
#include <gtest/gtest.h>

#include <cmath>

#include "action_client.h"
#include "cell_microinjection/FindTouchAction.h"
#include "controlled_needle.h"
#include "placed_specimen.h"

namespace microinjection {
namespace {

/// The needle is lowered until the image shows that it touches the cell.
class TouchTest : public testing::Test {
 protected:
  static constexpr double kRadius = 38e-6;       // m, of the cell mouse_oocyte_zona
  static constexpr double kAbove = 6e-6;         // m over the cell, where the approaches begin
  static constexpr double kAllowed = 0.5e-6;     // m, of the touch from the cell's surface
  static constexpr double kAllowedForce = 3e-9;  // N, of the force from the cell's
  static constexpr double kFarthest = 3.5e-6;    // m, past the touch

  TouchTest() {
    camera_.pixel = session_.parameters("microscope")["camera"]["pixel_size"].as<double>();
    session_.add("micromanipulator");
    // Little noise and no drift, so that a force of 20 nN is that of the cell.
    session_.add(
        "force_sensor",
        "{simulated: {axial_noise_density: 1.4e-12, axial_random_walk: 0.0, axial_drift_rate: 0.0, bits: 24}}");
    session_.add("cell_simulator");
    session_.add("injection_controller");
    session_.add("vision");
    session_.add("touch");
    session_.add("microscope", camera_.parameters(5));
    session_.run(0.2);
    needle_.moveTo({0, 0, kRadius + kAbove});
    session_.run(0.5);
    needle_.poses().clear();
  }

  void send(double travel = 0) {
    cell_microinjection::FindTouchGoal goal;
    goal.travel = travel;
    action_.send(goal);
  }
  cell_microinjection::FindTouchResult result() {
    EXPECT_TRUE(session_.until([&] { return action_.ended(); }, 60));
    return action_.ended() ? *action_.result() : cell_microinjection::FindTouchResult();
  }
  void setOff() {
    needle_.enable();
    send();
    ASSERT_TRUE(session_.until([&] { return needle_.place().z() < kRadius + kAbove - 1e-6 || action_.ended(); }, 20));
    ASSERT_FALSE(action_.ended()) << action_.result()->message;
  }
  void expectRefusal(double travel, const std::string& reason) {
    send(travel);
    const auto refused = result();
    EXPECT_FALSE(refused.success) << travel;
    EXPECT_NE(refused.message.find(reason), std::string::npos) << refused.message;
  }

  SmallCamera camera_{360, 420, {179.5, 259.5}};
  VirtualSession session_{{"cell:=mouse_oocyte_zona", "camera.source:=sim", "hand.device:=none",
                           "injection.mode:=manual", "injector:=none"}};
  ControlledNeedle needle_{session_};
  ActionClient<cell_microinjection::FindTouchAction> action_{session_.world(), "/touch/find"};
};

TEST_F(TouchTest, StopsAtTheTouch) {
  needle_.enable();
  send();
  const auto found = result();
  ASSERT_TRUE(found.success) << found.message;
  auto& cells = session_.world().hear<cell_microinjection::CellState>("/cell/state");
  ASSERT_TRUE(session_.until([&] { return cells.count() > 1; }, 1));
  EXPECT_NEAR(found.contact[2], kRadius, kAllowed);
  EXPECT_LT(found.interval, 0.5e-6);
  EXPECT_NEAR(found.force, cells.newest()->force.z, kAllowedForce);  // the second witness
  EXPECT_GT(found.force, 2 * kAllowedForce);
  EXPECT_TRUE(cells.newest()->in_contact);
  EXPECT_GT(needle_.lowest(), kRadius - kFarthest);
}

TEST_F(TouchTest, EndsWithTheTravel) {
  needle_.enable();
  expectRefusal(3e-6, "no touch within 3 um");
  EXPECT_GT(needle_.lowest(), kRadius + kAbove - 3.2e-6);
}

TEST_F(TouchTest, RefusesADisabledControllerAndATravelThatIsTooLong) {
  expectRefusal(0, "must be ENABLED");
  needle_.enable();
  for (const double travel : {1.0, -1e-6, static_cast<double>(NAN)}) expectRefusal(travel, "travel");
  EXPECT_NEAR(needle_.lowest(), kRadius + kAbove, 1e-9);
}

TEST_F(TouchTest, StopsWhenTheImagesAreCropped) {
  setOff();
  cropImages(session_);
  const auto result = this->result();
  EXPECT_NE(result.message.find("px now, and were of 360 x 420 px"), std::string::npos) << result.message;
  EXPECT_EQ(action_.state(), actionlib_msgs::GoalStatus::ABORTED);
  needle_.expectRests(0.3);
  EXPECT_GT(needle_.lowest(), kRadius);
}

TEST_F(TouchTest, StopsWhenItIsCancelled) {
  setOff();
  action_.cancel();
  result();
  EXPECT_EQ(action_.state(), actionlib_msgs::GoalStatus::PREEMPTED);
  needle_.expectRests(0.3);
  EXPECT_GT(needle_.lowest(), kRadius);
}

}  // namespace
}  // namespace microinjection
