#include <string>
#include <utility>
#include <vector>

#include "operation/control/injection_fixture.h"

namespace microinjection {
namespace {

using InjectionRunTest = InjectionFixture;

TEST_F(InjectionRunTest, WholeInjection) {
  enable();
  std::vector<std::string> states;
  const Eigen::Vector3d start = rig_.tip;
  while (controller_.busy() && states.size() < 100) {
    rig_.step(controller_);
    if (states.empty() || states.back() != toText(controller_.injection()))
      states.push_back(toText(controller_.injection()));
  }
  EXPECT_EQ(states, (std::vector<std::string>{"approach", "contact", "indent", "punctured", "inject", "punctured",
                                              "withdraw", "idle"}));
  const InjectionResult& result = controller_.result();
  EXPECT_EQ(result.outcome, InjectionOutcome::kInjected) << result.reason;
  EXPECT_EQ(result.punctures, 1);
  EXPECT_NEAR(result.volume, 0.2e-15, 2e-18);
  EXPECT_NEAR(*result.puncture_force, rig_.puncture_force, 0.1 * rig_.puncture_force);
  EXPECT_NEAR(result.peak_force, rig_.puncture_force, 5 * rig_.noise);
  // 10 um deep the membrane fails; touched a little below the surface; margin, and what is gone on until it is felt.
  EXPECT_GT(rig_.deepest, 10e-6 + config_.goal.margin - 0.5e-6);
  EXPECT_LT(rig_.deepest, 10e-6 + config_.goal.margin + config_.motion.overshoot);
  EXPECT_NEAR(result.max_depth, rig_.deepest, 1e-6);
  steps(100);
  EXPECT_LT((rig_.tip - start).norm(), 1e-9);
}

TEST_F(InjectionRunTest, SamePlaceAndOutcomeWithoutNoise) {
  rig_.noise = 0;
  enable();
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected) << controller_.result().reason;
}

TEST_F(InjectionRunTest, GoesThroughOneLayerAfterTheOther) {
  rig_.second_force = 0.5e-6;
  config_.goal.layers = 2;
  enable();
  ASSERT_TRUE(reach(InjectionState::kPunctured));
  EXPECT_FALSE(rig_.second_punctured);
  ASSERT_TRUE(reach(InjectionState::kInject));
  EXPECT_TRUE(rig_.second_punctured);
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected) << controller_.result().reason;
  EXPECT_EQ(controller_.result().punctures, 2);
  EXPECT_NEAR(*controller_.result().puncture_force, 0.3e-6 + 0.5e-6, 0.1e-6);
}

TEST_F(InjectionRunTest, FeedbackTellsWhichLayerComesNext) {
  rig_.second_force = 0.5e-6;
  config_.goal.layers = 2;
  enable();
  std::vector<std::pair<std::string, int>> told;
  while (controller_.busy()) {
    rig_.step(controller_);
    const InjectionFeedback feedback = controller_.feedback();
    EXPECT_EQ(feedback.layers, 2);
    const std::pair<std::string, int> now(toText(feedback.state), feedback.layer);
    if (told.empty() || now != told.back()) told.push_back(now);
  }
  const std::vector<std::pair<std::string, int>> expected = {
      {"approach", 1},  {"contact", 1}, {"indent", 1},    {"punctured", 2}, {"indent", 2},
      {"punctured", 3}, {"inject", 3},  {"punctured", 3}, {"withdraw", 3},  {"idle", 3}};
  EXPECT_EQ(told, expected);
}

TEST_F(InjectionRunTest, NeverFasterThanTheRig) {
  enable();
  controller_.adaptTo(8e-6, 5e-3);
  double fastest = 0;
  while (controller_.busy()) {
    const Eigen::Vector3d before = *rig_.setpoint;
    rig_.step(controller_);
    fastest = std::max(fastest, (*rig_.setpoint - before).norm() / SpringRig::kStep);
  }
  EXPECT_NEAR(fastest, 8e-6, 1e-9);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected) << controller_.result().reason;
}

TEST_F(InjectionRunTest, NoCellIsNoContact) {
  rig_.surface = -1;
  enable();
  const Eigen::Vector3d start = rig_.tip;
  rig_.run(controller_);
  steps(100);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kNoContact);
  EXPECT_LT((rig_.tip - start).norm(), 1e-9);
}

TEST_F(InjectionRunTest, ForceAcrossThePipetteIsNoContact) {
  enable();
  for (int i = 0; i < 1000; ++i) {
    rig_.sense(controller_);
    rig_.input.force->x() = 1e-6;
    rig_.setpoint = controller_.step(rig_.input, SpringRig::kStep);
    rig_.move();
    if (rig_.tip.z() < rig_.surface) break;
    ASSERT_EQ(controller_.injection(), InjectionState::kApproach);
  }
}

TEST_F(InjectionRunTest, MembraneThatHoldsEndsHeldAtDepth) {
  rig_.puncture_force = 1;
  enable();
  rig_.run(controller_);
  steps(100);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kNotPunctured);
  EXPECT_EQ(controller_.state(), OperatingState::kPaused);
  EXPECT_EQ(controller_.injection(), InjectionState::kIndent);
  EXPECT_NEAR(rig_.depth(), config_.goal.depth, 1e-6);
  EXPECT_EQ(controller_.command("resume"), "");
  steps(100);
  EXPECT_NEAR(rig_.depth(), config_.goal.depth, 1e-6) << "what is over does not go on";
  EXPECT_EQ(controller_.command("withdraw"), "");
  rig_.run(controller_);
  steps(20);
  EXPECT_EQ(rig_.depth(), 0);
  EXPECT_EQ(controller_.injection(), InjectionState::kIdle);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kNotPunctured) << "is not rewritten";
}

TEST_F(InjectionRunTest, IndentsOnlyWhereNoPunctureIsAskedFor) {
  config_.goal.puncture = false;
  config_.goal.depth = 8e-6;
  enable();
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kIndented);
  EXPECT_NEAR(controller_.result().max_depth, 8e-6, 0.1e-6);
  EXPECT_EQ(controller_.result().punctures, 0);
}

TEST_F(InjectionRunTest, GuardsHoldTheNeedle) {
  config_.guards.force_limit = 0.8e-6;
  enable();
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kGuard);
  EXPECT_NE(controller_.result().reason.find("N, allowed 8e-07 N"), std::string::npos) << controller_.result().reason;
  expectSafe("force");
  EXPECT_LT(rig_.largest_force, 0.85e-6);
  EXPECT_FALSE(rig_.punctured);

  rig_ = SpringRig();
  config_.guards.force_limit = 15e-6;
  config_.guards.depth_limit = 5e-6;
  rig_.puncture_force = 1;
  enable();
  rig_.run(controller_);
  expectSafe("depth");
  EXPECT_LT(rig_.deepest, 5e-6 + 0.7e-6);

  rig_ = SpringRig();
  config_.guards.depth_limit = 50e-6;
  config_.guards.time_limit = 0.1;
  enable();
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kGuard);
  EXPECT_NE(controller_.result().reason.find("time in state approach"), std::string::npos)
      << controller_.result().reason;
  expectSafe("time");
}

TEST_F(InjectionRunTest, VolumeEndsThePulse) {
  config_.goal.pulse.volume = 0.05e-15;
  enable();
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected);
  EXPECT_NEAR(rig_.volume, 0.05e-15, 3e-18);
}

}  // namespace
}  // namespace microinjection
