#include <limits>
#include <string>
#include <vector>

#include "operation/control/injection_fixture.h"

namespace microinjection {
namespace {

using InjectionModesTest = InjectionFixture;

TEST_F(InjectionModesTest, SemiAutomaticWaitsForTheOperatorsWord) {
  config_.mode = "semi_automatic";
  enable();
  steps(1000);
  EXPECT_EQ(controller_.injection(), InjectionState::kIdle);
  EXPECT_NE(controller_.command("indent"), "");
  EXPECT_EQ(controller_.command("approach"), "");
  EXPECT_NE(controller_.command("approach"), "");
  ASSERT_TRUE(reach(InjectionState::kContact));
  steps(5000);
  ASSERT_EQ(controller_.injection(), InjectionState::kContact);
  EXPECT_TRUE(controller_.awaitsCommand());
  const double before = rig_.depth();
  EXPECT_NE(controller_.command("inject"), "");
  EXPECT_EQ(controller_.command("indent"), "");
  ASSERT_TRUE(reach(InjectionState::kPunctured));
  EXPECT_GT(rig_.depth(), before + 5e-6);
  steps(5000);
  ASSERT_EQ(controller_.injection(), InjectionState::kPunctured);
  EXPECT_EQ(controller_.command("inject"), "");
  ASSERT_TRUE(reach(InjectionState::kInject));
  ASSERT_TRUE(reach(InjectionState::kPunctured));
  steps(5000);
  ASSERT_EQ(controller_.injection(), InjectionState::kPunctured);
  EXPECT_NE(controller_.command("inject"), "") << "once";
  EXPECT_EQ(controller_.command("withdraw"), "");
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected);
  EXPECT_EQ(controller_.command("approach"), "") << "again";
}

TEST_F(InjectionModesTest, CommandsOfAnotherModeAreRefused) {
  enable();
  ASSERT_TRUE(reach(InjectionState::kContact));
  EXPECT_NE(controller_.command("indent"), "");
  EXPECT_NE(controller_.start(config_.goal), "");
  config_.mode = "manual";
  enable();
  for (const char* command : {"approach", "indent", "withdraw", "inject"}) {
    EXPECT_NE(controller_.command(command), "") << command;
  }
}

TEST_F(InjectionModesTest, GoalsThatAreUnsoundAreRefused) {
  config_.start_when_enabled = false;
  enable();
  InjectionGoal goal = config_.goal;
  goal.depth = 1.1 * config_.guards.depth_limit;
  EXPECT_NE(controller_.start(goal), "");
  goal.depth = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(controller_.start(goal).find("depth = nan"), std::string::npos);
  goal = config_.goal;
  goal.layers = 0;
  EXPECT_NE(controller_.start(goal), "");
  EXPECT_EQ(controller_.start(config_.goal), "");
}

TEST_F(InjectionModesTest, HandsInjectionIsNamedAndNotMoved) {
  config_.mode = "manual";
  enable();
  std::vector<std::string> states;
  const auto go = [&](double z, int count) {
    const Eigen::Vector3d from = *rig_.input.target;
    for (int i = 1; i <= count; ++i) {
      rig_.input.target = from + (Eigen::Vector3d(0, 0, z) - from) * i / count;
      rig_.step(controller_);
      if (states.empty() || states.back() != toText(controller_.injection()))
        states.push_back(toText(controller_.injection()));
      EXPECT_LT((*rig_.setpoint - *rig_.input.target).norm(), 1e-12);
    }
  };
  rig_.input.target = rig_.tip;
  go(40e-6, 400);
  go(14e-6, 1000);
  go(14e-6, 100);
  EXPECT_EQ(controller_.command("inject"), "");
  EXPECT_TRUE(controller_.pulse());
  go(14e-6, 400);
  EXPECT_NEAR(rig_.volume, 0.2e-15, 2e-18);
  go(40e-6, 1000);
  EXPECT_EQ(states, (std::vector<std::string>{"idle", "approach", "contact", "indent", "punctured", "inject",
                                              "punctured", "withdraw", "idle", "approach"}));
}

TEST_F(InjectionModesTest, AWordThatWasNotDoneIsToldUntilTheNextOne) {
  config_.mode = "manual";
  rig_.input.target = rig_.tip;
  enable();
  EXPECT_EQ(controller_.notice(), "");
  controller_.command("inject");
  EXPECT_EQ(controller_.notice(), "inject refused: it is no step from idle");
  steps(100);
  EXPECT_NE(controller_.notice(), "");
  controller_.command("pause");
  EXPECT_EQ(controller_.notice(), "");
}

TEST_F(InjectionModesTest, APulseByHandThatEndsEarlyIsTold) {
  config_.mode = "manual";
  rig_.input.target = rig_.tip;
  enable();
  for (int i = 0; i < 3000; ++i) {
    *rig_.input.target -= Eigen::Vector3d(0, 0, 20e-9);
    rig_.step(controller_);
    if (controller_.injection() == InjectionState::kPunctured) break;
  }
  rig_.input.target.reset();  // whose operator has let go for a menu or another key
  steps(1000);
  EXPECT_EQ(controller_.holdReason(), "no valid target");
  ASSERT_EQ(controller_.command("inject"), "");
  ASSERT_EQ(controller_.injection(), InjectionState::kInject);
  EXPECT_EQ(controller_.notice(), "");
  steps(20);
  rig_.force_tells = false;
  steps(2);
  EXPECT_FALSE(controller_.pulse());
  EXPECT_EQ(controller_.notice(), "the pulse was ended: no valid force");
  rig_.force_tells = true;
  steps(100);
  ASSERT_EQ(controller_.command("inject"), "");
  EXPECT_EQ(controller_.notice(), "");
  steps(1000);
  EXPECT_EQ(controller_.notice(), "") << "it was done";
  EXPECT_EQ(controller_.injection(), InjectionState::kPunctured);
  ASSERT_EQ(controller_.command("inject"), "");
  rig_.sense(controller_);
  rig_.input.injector = InjectorReport{false, 0, false, "it is too short"};
  controller_.step(rig_.input, SpringRig::kStep);
  EXPECT_EQ(controller_.notice(), "the injector refused the pulse: it is too short");
  EXPECT_EQ(controller_.injection(), InjectionState::kPunctured);
  rig_.force_tells = false;
  steps(2);
  EXPECT_EQ(controller_.command("inject"), "the needle is held: no valid force");
  rig_.force_tells = true;
  steps(100);
  ASSERT_EQ(controller_.command("inject"), "");
  steps(20);
  rig_.input.target = rig_.tip;
  for (int i = 0; i < 200; ++i) {
    *rig_.input.target += Eigen::Vector3d(0, 0, 20e-9);
    rig_.step(controller_);
  }
  EXPECT_FALSE(controller_.pulse());
  EXPECT_EQ(controller_.notice(), "the pulse was ended: the needle is withdrawn");
}

TEST_F(InjectionModesTest, HandIsStoppedAtTheDepthLimit) {
  config_.mode = "manual";
  config_.guards.depth_limit = 5e-6;
  rig_.input.target = rig_.tip;
  enable();
  for (int i = 0; i < 3000; ++i) {
    if (i > 400) *rig_.input.target -= Eigen::Vector3d(0, 0, 10e-9);
    rig_.step(controller_);
  }
  EXPECT_NEAR(rig_.depth(), 5e-6, 1.0e-6);
  EXPECT_NE(controller_.holdReason().find("only be withdrawn"), std::string::npos);
}

}  // namespace
}  // namespace microinjection
