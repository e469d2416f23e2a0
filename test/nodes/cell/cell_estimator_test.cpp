// The cell under the needle is another one than the session believes in, three times as stiff and a little higher: its
// force is found and felt while it is indented.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cell_microinjection/CellEstimate.h"
#include "cell_microinjection/CellParameters.h"
#include "led_hand.h"

namespace microinjection {
namespace {

using geometry_msgs::WrenchStamped;
constexpr double kModelledSurface = 28e-6;         // m, of the cell that the session believes in
constexpr double kHigher = 0.3e-6;                 // m, of the true one
constexpr double kPrior = 17.9e3, kTrue = 53.7e3;  // Pa
constexpr double kForceRateLimit = 100;            // N/s, config/haptic_bridge.yaml
constexpr double kLargestStep = 0.04;  // of the force in 1 ms; a change of the cell by 28 % takes 20 of them

class EstimatorTest : public testing::Test {
 protected:
  struct Row {
    double depth, predicted, true_force, hand_force, modulus;
  };

  EstimatorTest() {
    session_.world().hear<cell_microinjection::CellEstimate>("cell/estimate");
    session_.world().hear<WrenchStamped>("cell/predicted_cf");
    session_.world().hear<WrenchStamped>("true_cell/predicted_cf");
    session_.start();
    setCell("true_cell/set_parameters", "height", kHigher);
    session_.run(0.15);  // the loop closes and its ramp is over
  }

  void setCell(const std::string& topic, const std::string& name, double value) {
    cell_microinjection::CellParameters message;
    message.name = {name};
    message.value = {value};
    session_.world().say(topic, message);
  }
  /// The needle to a height (m) at a speed (m/s).
  std::vector<Row> moveTo(double height, double speed) {
    std::vector<Row> rows;
    const double start = hand_.z, goal = start + (height - hand_.needle().z()) / LedHand::kScale;
    const int steps =
        std::max(1, static_cast<int>(std::lround(1e3 * std::abs(goal - start) * LedHand::kScale / speed)));
    for (int i = 1; i <= steps; ++i) {
      hand_.z = start + (goal - start) * i / steps;
      session_.run(1e-3);
      rows.push_back({kModelledSurface - hand_.needle().z(), force("cell/predicted_cf"),
                      force("true_cell/predicted_cf"), hand_.force().z(), estimate().modulus});
    }
    return rows;
  }
  void approach() {
    moveTo(kModelledSurface + 4e-6, 100e-6);
    session_.run(0.3);
  }
  std::vector<Row> indent() { return moveTo(kModelledSurface - 10e-6, 20e-6); }

  double force(const std::string& topic) {
    return session_.world().hear<WrenchStamped>(topic).newest()->wrench.force.z;
  }
  const cell_microinjection::CellEstimate& estimate() {
    return *session_.world().hear<cell_microinjection::CellEstimate>("cell/estimate").newest();
  }

  VirtualSession session_{{"cell:=mouse_oocyte_pipette", "hidden:=" + testFile("scenes/stiffer_oocyte.yaml"),
                           "estimator:=true", "hand.device:=external", "hand.require_operator:=false",
                           "display.markers:=false"}};
  LedHand hand_{session_};
};

TEST_F(EstimatorTest, KnowsNothingBeforeContact) {
  approach();
  EXPECT_EQ(estimate().verdict, "prior");
  EXPECT_NEAR(estimate().served_modulus, kPrior, 1);
}

TEST_F(EstimatorTest, TheFeltForceBecomesThatOfTheTrueCell) {
  approach();
  const std::vector<Row> rows = indent();
  double hand_step = 0, force_step = 0, modulus_error = 0, force_error = 0, least = INFINITY;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const Row &row = rows[i], &before = rows[i - 1];
    hand_step = std::max(hand_step, std::abs(row.hand_force - before.hand_force));
    if (before.predicted > 0.2e-6)
      force_step = std::max(force_step, std::abs(row.predicted - before.predicted) / before.predicted);
    if (row.depth >= 5e-6) modulus_error = std::max(modulus_error, std::abs(row.modulus / kTrue - 1));
    if (row.depth < 8e-6) continue;
    force_error = std::max(force_error, std::abs(row.predicted / row.true_force - 1));
    least = std::min(least, row.true_force);
  }
  EXPECT_LT(modulus_error, 0.05) << "from 5 um on";
  EXPECT_LT(force_error, 0.03) << "from 8 um on";
  EXPECT_GT(least, 2e-6);
  EXPECT_LT(least, INFINITY);
  EXPECT_LT(hand_step, kForceRateLimit * 1e-3 * 1.001);
  // The changes of the served cell are spread over time: a step of the force is a small share of it.
  EXPECT_LT(force_step, kLargestStep);
  EXPECT_EQ(estimate().verdict, "converged");
  EXPECT_LE(estimate().modulus_low, kTrue);
  EXPECT_GE(estimate().modulus_high, kTrue);
  EXPECT_NEAR(estimate().served_height, kHigher, 0.05e-6);
}

TEST_F(EstimatorTest, AHandThatIsGoneTeachesNothing) {
  approach();
  indent();
  const double modulus = estimate().modulus;
  EXPECT_NEAR(modulus / kTrue, 1, 0.05);
  hand_.silent = true;
  session_.world().say("haptic/measured_cp", poseMessage(0, 0, hand_.z, "haptic"));  // stamp 0: invalid
  session_.run(0.05);
  EXPECT_EQ(hand_.force().norm(), 0);
  EXPECT_NEAR(estimate().modulus / modulus, 1, 0.02);
}

TEST_F(EstimatorTest, TheNextIndentationBeginsWithTheCellThatWasFound) {
  approach();
  indent();
  moveTo(kModelledSurface + 12e-6, 50e-6);
  session_.run(0.3);
  EXPECT_EQ(estimate().verdict, "prior");
  EXPECT_NEAR(estimate().modulus / kTrue, 1, 0.03);
  EXPECT_NEAR(estimate().served_modulus / kTrue, 1, 0.03);
}

TEST_F(EstimatorTest, ACellOfAnotherSizeIsUnknown) {
  approach();
  indent();
  moveTo(kModelledSurface + 12e-6, 50e-6);
  session_.run(0.3);
  setCell("cell/set_parameters", "diameter", 60e-6);
  session_.run(0.3);
  EXPECT_EQ(estimate().verdict, "prior");
  EXPECT_EQ(estimate().modulus, kPrior);
  EXPECT_EQ(estimate().served_height, 0) << "the height was that of the cell before";
  moveTo(30e-6 - 6e-6, 20e-6);
  session_.run(0.1);
  // Modelled 1.7 um too high: that is found, too, since the prior of the surface's height is wide enough.
  EXPECT_NEAR(estimate().contact, kModelledSurface + kHigher - 30e-6, 0.1e-6);
  EXPECT_NEAR(estimate().modulus / kTrue, 1, 0.05);
}

}  // namespace
}  // namespace microinjection
