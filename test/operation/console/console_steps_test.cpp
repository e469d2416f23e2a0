#include <gtest/gtest.h>

#include "operation/console/focus_steps.h"
#include "operation/console/needle_steps.h"

namespace microinjection {
namespace {

TEST(FocusSteps, AddUpWhileTheMotorIsOnItsWay) {
  FocusView focus;
  focus.position = 2e-6;
  EXPECT_DOUBLE_EQ(focusGoal(focus, 5e-6), 7e-6);
  focus.goal = 7e-6;
  EXPECT_DOUBLE_EQ(focusGoal(focus, 5e-6), 12e-6);
  EXPECT_DOUBLE_EQ(focusGoal(focus, -5e-6), 2e-6);
}

TEST(FocusSteps, AreRefusedWithAReason) {
  FocusView focus;
  EXPECT_EQ(offerFocusStep(focus, 1e-6).refusal, "/focus/measured_js is silent");
  focus.position = 2e-6;
  EXPECT_EQ(offerFocusStep(focus, 1e-6).refusal, "");
  EXPECT_EQ(offerFocusStep(focus, 1e-6).effect, "at 2.0 um");
  focus.lowest = -1e-6;
  focus.highest = 5e-6;
  EXPECT_EQ(offerFocusStep(focus, 2e-6).refusal, "");
  EXPECT_NE(offerFocusStep(focus, 4e-6).refusal.find("ends at 5.0 um"), std::string::npos);
  EXPECT_NE(offerFocusStep(focus, -4e-6).refusal.find("ends at -1.0 um"), std::string::npos);
  focus.searched = true;
  EXPECT_NE(offerFocusStep(focus, 1e-6).refusal.find("is searched"), std::string::npos);
}

NeedleView restingNeedle() {
  NeedleView needle;
  needle.tip = Eigen::Vector3d(1e-6, -2e-6, 80e-6);
  needle.state = OperatingState::kEnabled;
  return needle;
}

TEST(NeedleSteps, AddUpWhileTheNeedleIsOnItsWay) {
  NeedleView needle = restingNeedle();
  EXPECT_EQ(needleGoal(needle, {0, 0, 5e-6}), Eigen::Vector3d(1e-6, -2e-6, 85e-6));
  needle.goal = Eigen::Vector3d(0, 0, 90e-6);
  EXPECT_EQ(needleGoal(needle, {-1e-6, 0, 0}), Eigen::Vector3d(-1e-6, 0, 90e-6));
}

/// The second node that commands the needle would be a fault of the rig.
TEST(NeedleSteps, LeaveTheNeedleToTheControllerUnlessItIsDisabled) {
  SessionView session;
  session.listens = false;
  EXPECT_EQ(offerNeedleStep(restingNeedle(), session).refusal, "");
  EXPECT_EQ(offerNeedleStep(restingNeedle(), session).effect, "at 1.0, -2.0, 80.0 um");
  session.operating = OperatingState::kDisabled;
  EXPECT_EQ(offerNeedleStep(restingNeedle(), session).refusal, "");
  for (const OperatingState state : {OperatingState::kEnabled, OperatingState::kPaused, OperatingState::kFault}) {
    session.operating = state;
    EXPECT_EQ(offerNeedleStep(restingNeedle(), session).refusal, std::string(toText(state)) + ": press Disable first");
  }
}

/// A controller that does not report may go on at any time, with its old set-point.
TEST(NeedleSteps, WaitForAControllerThatIsSilent) {
  SessionView session;
  session.listens = true;
  EXPECT_EQ(offerNeedleStep(restingNeedle(), session).refusal, "the controller is silent");
  session.operating = OperatingState::kDisabled;
  EXPECT_EQ(offerNeedleStep(restingNeedle(), session).refusal, "");
}

TEST(NeedleSteps, WaitForAnotherNodesMove) {
  SessionView session;
  session.operating = OperatingState::kDisabled;
  NeedleView needle = restingNeedle();
  needle.busy = true;
  EXPECT_EQ(offerNeedleStep(needle, session).refusal, "the needle is on its way");
  needle.goal = Eigen::Vector3d(0, 0, 90e-6);
  EXPECT_EQ(offerNeedleStep(needle, session).refusal, "");
}

TEST(NeedleSteps, NeedAnEnabledNeedleThatNobodyElseMoves) {
  SessionView session;
  session.operating = OperatingState::kDisabled;
  NeedleView needle = restingNeedle();
  needle.tip.reset();
  EXPECT_EQ(offerNeedleStep(needle, session).refusal, "the needle's position is not known");
  needle.state = OperatingState::kFault;
  EXPECT_EQ(offerNeedleStep(needle, session).refusal, "the micromanipulator is FAULT");
  needle.calibrating = true;
  EXPECT_EQ(offerNeedleStep(needle, session).refusal, "the calibration moves the needle");
  needle.state.reset();
  EXPECT_EQ(offerNeedleStep(needle, session).refusal, "no node micromanipulator");
}

}  // namespace
}  // namespace microinjection
