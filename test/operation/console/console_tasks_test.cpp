#include <gtest/gtest.h>

#include "operation/console/camera_tasks.h"
#include "operation/console/console_parts.h"
#include "operation/console/guard_margins.h"
#include "operation/console/hand_lines.h"
#include "operation/console/pixel_goal.h"

namespace microinjection {
namespace {

TEST(ConsoleParts, AreReadFromWords) {
  const ConsoleParts parts = ConsoleParts::read("  hand plots ");
  for (const ConsolePart part : kConsoleParts) {
    const bool expected =
        part == ConsolePart::kHand || part == ConsolePart::kPlots || part == ConsolePart::kCommands;  // STOP
    EXPECT_EQ(parts.has(part), expected) << toText(part);
  }
  EXPECT_EQ(parts.unknown, "");
}

TEST(ConsoleParts, EveryPartHasAWordOfItsOwn) {
  std::string words;
  for (const ConsolePart part : kConsoleParts) words += std::string(toText(part)) + " ";
  const ConsoleParts parts = ConsoleParts::read(words);
  for (const ConsolePart part : kConsoleParts) EXPECT_TRUE(parts.has(part)) << toText(part);
}

TEST(ConsoleParts, NameWhatIsNoPart) {
  EXPECT_EQ(ConsoleParts::read("cell plot guards lamp").unknown, "plot lamp");
  EXPECT_EQ(ConsoleParts::read(kUsualParts).unknown, "");
}

TEST(HandLines, FollowTheBridge) {
  HandView hand;
  EXPECT_EQ(followsLamp(hand).light, Light::kGrey);
  hand.hold_reason = "";
  EXPECT_EQ(followsLamp(hand).light, Light::kGreen);
  hand.hold_reason = "the operator is absent";
  EXPECT_EQ(followsLamp(hand).light, Light::kYellow);
  EXPECT_EQ(followsLamp(hand).text, "held: the operator is absent");
  hand.hold_reason.reset();
  hand.has_bridge = true;
  EXPECT_EQ(followsLamp(hand).light, Light::kRed);
}

TEST(HandLines, ShowClutchAndDeadManSwitch) {
  HandView hand;
  EXPECT_EQ(clutchLamp(hand).light, Light::kGrey);
  EXPECT_EQ(presentLamp(hand).light, Light::kGrey);
  hand.clutch = hand.present = true;
  EXPECT_EQ(clutchLamp(hand).light, Light::kYellow);
  EXPECT_EQ(presentLamp(hand).light, Light::kGreen);
  hand.clutch = hand.present = false;
  EXPECT_EQ(clutchLamp(hand).light, Light::kGreen);
  EXPECT_EQ(presentLamp(hand).light, Light::kYellow);
}

TEST(HandLines, ScalesAreThoseOfTheParameters) {
  HandSettings settings;
  EXPECT_EQ(positionScaleText(settings), "-");
  EXPECT_EQ(forceScaleText(settings), "-");
  settings = {"position", "blend", 1.5e-3, 2e-3, 2e5};
  EXPECT_EQ(positionScaleText(settings), "1 mm of the hand: 1.50 um");
  EXPECT_EQ(forceScaleText(settings), "1 uN at the tip: 0.20 N, blend");
  settings.mode = "rate";
  EXPECT_EQ(positionScaleText(settings), "10 mm of the hand: 20.0 um/s");
}

SessionView sessionIn(OperatingState state, const std::string& mode) {
  SessionView session;
  session.operating = state;
  session.injection = InjectionState::kIdle;
  session.settings.mode = mode;
  return session;
}

TEST(CameraTasks, NeedTheirNodeAndOneAnotherEnd) {
  const SessionView session = sessionIn(OperatingState::kDisabled, "manual");
  for (const CameraTask task : kCameraTasks) {
    EXPECT_NE(offer(task, session, false, std::nullopt).refusal.find("no node "), std::string::npos);
    EXPECT_EQ(offer(task, session, true, CameraTask::kFocus).refusal, "Focus is under way");
    EXPECT_EQ(offer(task, session, true, std::nullopt).label, toText(task));
  }
}

TEST(CameraTasks, TwoNodesNeverCommandTheNeedle) {
  const auto refusal = [](CameraTask task, const SessionView& session) {
    return offer(task, session, true, std::nullopt).refusal;
  };
  const SessionView disabled = sessionIn(OperatingState::kDisabled, "manual");
  EXPECT_EQ(refusal(CameraTask::kCalibrate, disabled), "");
  EXPECT_NE(refusal(CameraTask::kTouch, disabled), "");
  for (const OperatingState state : {OperatingState::kEnabled, OperatingState::kPaused, OperatingState::kFault}) {
    EXPECT_NE(refusal(CameraTask::kCalibrate, sessionIn(state, "manual")), "");
  }
  EXPECT_EQ(refusal(CameraTask::kTouch, sessionIn(OperatingState::kEnabled, "manual")), "");
  EXPECT_EQ(refusal(CameraTask::kTouch, sessionIn(OperatingState::kEnabled, "automatic")),
            "mode is automatic, must be manual");
  // A session without a controller has only the needle.
  EXPECT_EQ(refusal(CameraTask::kCalibrate, SessionView()), "");
  EXPECT_EQ(refusal(CameraTask::kFocus, sessionIn(OperatingState::kEnabled, "manual")), "");
}

TEST(CameraTasks, ReportTheirEnd) {
  using State = CameraTaskReport::State;
  EXPECT_EQ(reportLamp({}).light, Light::kGrey);
  EXPECT_EQ(reportLamp({State::kRunning, CameraTask::kFocus, "plane 3 of 21"}).light, Light::kYellow);
  EXPECT_EQ(reportLamp({State::kSucceeded, CameraTask::kRezero, "done"}).light, Light::kGreen);
  const Lamp failed = reportLamp({State::kFailed, CameraTask::kCalibrate, "the needle is moving"});
  EXPECT_EQ(failed.light, Light::kRed);
  EXPECT_EQ(failed.text, "Calibrate: the needle is moving");
}

TEST(ScoreLines, ABarFillsUpToTheReference) {
  TrainingTask task;
  task.peak_force = 1.6e-6;
  task.punctures = 2;
  task.volume = 0;
  TrainingScore score;
  score.peak_force = 1.2e-6;
  score.punctures = 1;
  auto margins = scoreMargins(score, task);
  ASSERT_EQ(margins.size(), 6U);
  EXPECT_EQ(margins[0].name, "peak force");
  EXPECT_EQ(margins[0].lamp.text, "1.20 of 1.60 uN");
  EXPECT_NEAR(margins[0].share, 0.75, 1e-12);
  EXPECT_EQ(margins[0].lamp.light, Light::kGreen);
  EXPECT_EQ(margins[4].lamp.text, "1 of 2");
  EXPECT_EQ(margins[4].lamp.light, Light::kGrey);   // not yet
  EXPECT_EQ(margins[5].lamp.light, Light::kGreen);  // nothing is to be injected, and nothing was
  score.peak_force = 2.4e-6;
  score.punctures = 2;
  score.volume = 1e-15;
  margins = scoreMargins(score, task);
  EXPECT_EQ(margins[0].lamp.light, Light::kYellow);
  EXPECT_EQ(margins[4].lamp.light, Light::kGreen);
  EXPECT_EQ(margins[5].lamp.light, Light::kRed);
  score.peak_force = 3.3e-6;
  score.punctures = 3;
  margins = scoreMargins(score, task);
  EXPECT_EQ(margins[0].lamp.light, Light::kRed);
  EXPECT_EQ(margins[4].lamp.light, Light::kYellow);
}

TEST(ScoreLines, ShowPointsOnlyOfACompleteSession) {
  TrainingScore score;
  score.outcome = TrainingOutcome::kUntouched;
  score.reason = "no cell was touched";
  EXPECT_EQ(scoreText(score), "ended now: no points, no cell was touched");
  score.outcome = TrainingOutcome::kComplete;
  score.points = {25, 15, 20, 10, 10, 3};
  EXPECT_EQ(scoreText(score), "ended now: 83 of 100 points");
}

TEST(PixelGoal, IsOfferedOnlyAfterAClickAndWhenTheNeedleCanBeLed) {
  SessionView session;
  PixelGoal goal;
  EXPECT_EQ(offer(goal, session, false).refusal, "no node visual_servo: start the session with camera:=");
  EXPECT_EQ(offer(goal, session, true).refusal, "click where the tip shall go");
  goal.pixel = Eigen::Vector2d(12.4, 700.6);
  EXPECT_EQ(offer(goal, session, true).refusal, "the controller must be ENABLED: press Enable first");
  session.operating = OperatingState::kEnabled;
  EXPECT_EQ(offer(goal, session, true).refusal, "");
  EXPECT_EQ(offer(goal, session, true).effect, "brings the tip to (12, 701) px");
  session.settings.mode = "automatic";
  EXPECT_EQ(offer(goal, session, true).refusal, "mode is automatic, must be manual");
  goal.under_way = true;
  EXPECT_EQ(offer(goal, session, true).refusal, "the needle is on its way");
}

}  // namespace
}  // namespace microinjection
