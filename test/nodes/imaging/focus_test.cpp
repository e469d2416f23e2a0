#include <actionlib_msgs/GoalStatus.h>
#include <gtest/gtest.h>
#include <sensor_msgs/JointState.h>

#include <cmath>

#include "action_client.h"
#include "cell_microinjection/FindFocusAction.h"
#include "placed_specimen.h"

namespace microinjection {
namespace {

/// The focus is found on the tip of a needle that the test places under the virtual microscope.
class FocusTest : public testing::Test {
 protected:
  static constexpr double kAllowed = 0.3e-6;  // m, of the focus from the tip

  FocusTest() {
    session_.add("vision");
    session_.add("focus", "{planes: 13, images: 3}");  // fewer than shipped: less time
    session_.add("microscope", camera_.parameters(10, "needle: measured"));
    session_.world().hear<sensor_msgs::JointState>("/focus/measured_js");
    session_.world().hear<cell_microinjection::VisionState>("/vision/state");
    session_.run(0.2);
  }

  double focus() { return session_.world().hear<sensor_msgs::JointState>("/focus/measured_js").newest()->position[0]; }
  bool focusComesTo(double place, double tolerance) {
    return session_.until([&] { return std::abs(focus() - place) < tolerance; }, 2);
  }
  /// The tip at `depth` and the focus at `place`, m along y of the world; the tip is seen.
  void prepare(double depth, double place) {
    specimen_.tip.y() = depth;
    sensor_msgs::JointState message;
    message.name = {"focus"};
    message.position = {place};
    session_.world().say("/focus/move_jp", message);
    ASSERT_TRUE(focusComesTo(place, 1e-9));
    const auto& states = session_.world().hear<cell_microinjection::VisionState>("/vision/state");
    const std::size_t before = states.count();
    ASSERT_TRUE(session_.until(
        [&] {
          return states.count() > before &&
                 states.newest()->injection_pipette.verdict != cell_microinjection::PipetteInImage::NOT_FOUND;
        },
        2));
  }
  /// `during`: once the first feedback has come.
  cell_microinjection::FindFocusResult find(const std::function<void()>& during = [] {}) {
    action_.send({});
    EXPECT_TRUE(session_.until([&] { return action_.ended() || !action_.feedback().empty(); }, 1));
    during();
    EXPECT_TRUE(session_.until([&] { return action_.ended(); }, 60));
    return action_.ended() ? *action_.result() : cell_microinjection::FindFocusResult();
  }
  void expectFailure(const std::string& reason, const std::function<void()>& during) {
    prepare(0, 2e-6);
    const auto result = find(during);
    EXPECT_FALSE(result.success);
    EXPECT_NE(result.message.find(reason), std::string::npos) << result.message;
    EXPECT_EQ(action_.state(), actionlib_msgs::GoalStatus::ABORTED);
    EXPECT_TRUE(focusComesTo(2e-6, 1e-9)) << "it is not where it was";
  }

  SmallCamera camera_;
  VirtualSession session_{{"camera.source:=sim", "hand.device:=none"}};
  PlacedSpecimen specimen_{session_, 28e-6, {5e-6, 0, 60e-6}};
  ActionClient<cell_microinjection::FindFocusAction> action_{session_.world(), "/focus/find"};
};

TEST_F(FocusTest, FindsTheTipWhereverItIs) {
  const double cases[][2] = {{0, 5e-6},
                             {3.4e-6, -3e-6}};  // m: of the tip, of the focus; the second is beyond the planes
  for (const auto& [depth, place] : cases) {
    prepare(depth, place);
    const auto result = find();
    EXPECT_TRUE(result.success) << result.message;
    EXPECT_EQ(action_.state(), actionlib_msgs::GoalStatus::SUCCEEDED);
    EXPECT_NEAR(result.height, depth, kAllowed);
    EXPECT_LT(result.interval, 0.6e-6);
    EXPECT_NEAR(result.tip_height, depth - place, kAllowed);
    EXPECT_NEAR(focus(), result.height, 1e-7);
  }
}

TEST_F(FocusTest, FailsWhenTheNeedleMoves) {
  expectFailure("the needle moves", [&] { specimen_.tip.y() = 5e-6; });
}

TEST_F(FocusTest, FailsWhenTheImagesStop) {
  expectFailure("no fresh image", [&] { specimen_.cell_is_silent = true; });
}

TEST_F(FocusTest, FailsWhenTheImagesAreCropped) {
  expectFailure("px now, and were of 480 x 496 px", [&] { cropImages(session_); });
}

TEST_F(FocusTest, StopsWhenItIsCancelled) {
  prepare(0, 2e-6);
  action_.send({});
  ASSERT_TRUE(session_.until([&] { return std::abs(focus() - 2e-6) > 3e-6; }, 5));
  action_.cancel();
  session_.run(0.01);
  ASSERT_TRUE(action_.ended());
  EXPECT_EQ(action_.state(), actionlib_msgs::GoalStatus::PREEMPTED);
  EXPECT_EQ(action_.result()->message, "cancelled");
  session_.run(0.2);  // the microscope's next step
  const double stopped = focus();
  session_.run(0.5);
  EXPECT_EQ(focus(), stopped);
}

}  // namespace
}  // namespace microinjection
