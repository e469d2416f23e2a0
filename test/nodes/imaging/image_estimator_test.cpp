#include <actionlib_msgs/GoalStatus.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "action_client.h"
#include "cell_microinjection/CellEstimate.h"
#include "cell_microinjection/CellParameters.h"
#include "cell_microinjection/InjectAction.h"
#include "controlled_needle.h"
#include "felt_forces.h"
#include "placed_specimen.h"

namespace microinjection {
namespace {

/// Without a force sensor: the cell under the needle lies higher than the session believes, which the camera shows.
class ImageEstimatorTest : public testing::Test {
 protected:
  static constexpr double kRadius = 31e-6, kHeight = 1.2e-6;  // m; of the true cell above where the session has it
  static constexpr double kModulus = 17.9e3;                  // Pa, of both
  static constexpr double kExact = 0.3e-6;                    // m, of the height that images show
  static constexpr double kGap = 10e-6, kDepth = 8e-6;        // m

  ImageEstimatorTest() {
    session_.start();
    session_.run(0.2);
  }

  const cell_microinjection::CellEstimate& estimate() {
    static const cell_microinjection::CellEstimate kNone;
    const auto* newest = session_.world().hear<cell_microinjection::CellEstimate>("/cell/estimate").newest();
    return newest ? *newest : kNone;
  }

  SmallCamera camera_{480, 520, {239.5, 359.5}};
  VirtualSession session_{{"cell:=" + testFile("scenes/larger_oocyte.yaml"),
                           "hidden:=" + testFile("scenes/larger_oocyte.yaml"), "sensor.source:=none",
                           "camera.source:=sim", "estimator:=true", "hand.device:=none", "injector:=none",
                           "injection.mode:=automatic", "injection.start_when_enabled:=false", "display.markers:=false",
                           "overrides:={vision: {pixel_size: 0.25e-6}, microscope: " + camera_.parameters(10) + "}"}};
  ControlledNeedle needle_{session_};
  FeltForces forces_{session_};
  ActionClient<cell_microinjection::InjectAction> action_{session_.world(), "/controller/inject"};
};

TEST_F(ImageEstimatorTest, TheImageMovesTheServedCell) {
  session_.world().hear<cell_microinjection::CellEstimate>("/cell/estimate");
  cell_microinjection::CellParameters higher;
  higher.name = {"height"};
  higher.value = {kHeight};
  session_.world().say("/true_cell/set_parameters", higher);
  needle_.moveTo({0, 0, kRadius + kHeight + kGap});
  // The gap shows it before the touch.
  EXPECT_TRUE(session_.until([&] { return std::abs(estimate().served_height - kHeight) < kExact; }, 5))
      << 1e6 * estimate().served_height << " um";
  needle_.enable();
  forces_.clear();
  cell_microinjection::InjectGoal goal;
  goal.layers = 1;
  goal.depth = kDepth;
  goal.hold_time = 0.5;
  action_.send(goal);
  ASSERT_TRUE(session_.until([&] { return action_.ended(); }, 30));
  session_.run(0.2);
  EXPECT_EQ(action_.state(), actionlib_msgs::GoalStatus::SUCCEEDED);
  EXPECT_EQ(action_.result()->outcome, "indented");
  EXPECT_EQ(action_.result()->reason, "");
  EXPECT_NEAR(estimate().served_height, kHeight, kExact);
  // An image does not show the modulus. With the true one, the force is read from the image.
  EXPECT_EQ(estimate().verdict, "prior");
  EXPECT_EQ(estimate().served_modulus, kModulus);
  EXPECT_NE(estimate().held.find("no valid force of the sensor"), std::string::npos) << estimate().held;
  const auto pairs = forces_.pairs();
  const double largest = FeltForces::largest(pairs);
  std::size_t compared = 0;
  double worst = 0;
  for (const ForcePair& pair : pairs) {
    if (pair.truth <= 0.3 * largest) continue;
    ++compared;
    worst = std::max(worst, std::abs(pair.error()));
  }
  EXPECT_GT(compared, 1000u);  // half a second at depth, and more
  EXPECT_LT(worst, 0.1);
}

}  // namespace
}  // namespace microinjection
