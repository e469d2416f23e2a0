#include <gtest/gtest.h>

#include <limits>

#include "operation/console/cell_lines.h"
#include "operation/console/device_lamps.h"
#include "operation/console/guard_margins.h"
#include "operation/console/headline.h"
#include "operation/console/step_strip.h"

namespace microinjection {
namespace {

using Mark = StepStrip::Mark;
constexpr Mark kAhead = Mark::kAhead, kPassed = Mark::kPassed, kPresent = Mark::kPresent;

TEST(StepStrip, LightsThePresentStepAndRemembersThePassedOnes) {
  StepStrip strip;
  strip.update(InjectionState::kIdle);
  EXPECT_EQ(strip.marks()[0], kPresent);
  for (const InjectionState state : {InjectionState::kApproach, InjectionState::kContact, InjectionState::kIndent,
                                     InjectionState::kPunctured, InjectionState::kInject, InjectionState::kPunctured}) {
    strip.update(state);
  }
  const std::array<Mark, 8> injected = {kAhead, kPassed, kPassed, kPassed, kAhead, kPresent, kPassed, kAhead};
  EXPECT_EQ(strip.marks(), injected);
  strip.update(InjectionState::kWithdraw);
  EXPECT_EQ(strip.marks()[7], kPresent);
  strip.update(InjectionState::kIdle);
  const std::array<Mark, 8> idle = {kPresent, kAhead, kAhead, kAhead, kAhead, kAhead, kAhead, kAhead};
  EXPECT_EQ(strip.marks(), idle);
}

TEST(StepStrip, NamesTheFirstAndTheLastStepWhileTheCellIsTakenAndLetGo) {
  StepStrip strip;
  strip.update(InjectionState::kHold);
  EXPECT_EQ(strip.marks()[0], Mark::kPresent);
  EXPECT_STREQ(strip.text(0), "hold");
  strip.update(InjectionState::kApproach);
  EXPECT_STREQ(strip.text(0), "idle");
  strip.update(InjectionState::kRelease);
  EXPECT_EQ(strip.marks()[7], Mark::kPresent);
  EXPECT_STREQ(strip.text(7), "release");
}

TEST(StepStrip, LightsNothingInFaultOrWithoutAState) {
  StepStrip strip;
  strip.update(InjectionState::kApproach);
  strip.update(InjectionState::kFault);
  EXPECT_TRUE(strip.fault());
  EXPECT_EQ(strip.marks()[1], kPassed);
  strip.update(std::nullopt);
  EXPECT_FALSE(strip.fault());
  for (const Mark mark : strip.marks()) EXPECT_NE(mark, kPresent);
}

TEST(GuardMargins, TurnYellowNearTheLimitAndRedBeyondIt) {
  EXPECT_EQ(guardMargin("Force", 7.9e-6, 10e-6, "uN").lamp.light, Light::kGreen);
  EXPECT_EQ(guardMargin("Force", 8.1e-6, 10e-6, "uN").lamp.light, Light::kYellow);
  // The guard of the controller acts above its limit, not at it.
  EXPECT_EQ(guardMargin("Force", 10e-6, 10e-6, "uN").lamp.light, Light::kYellow);
  EXPECT_EQ(guardMargin("Force", -10.1e-6, 10e-6, "uN").lamp.light, Light::kRed);
  EXPECT_EQ(guardMargin("Force", 2.5e-6, 10e-6, "uN").lamp.text, "2.50 of 10.0 uN");
  EXPECT_DOUBLE_EQ(guardMargin("Force", 2.5e-6, 10e-6, "uN").share, 0.25);
}

TEST(GuardMargins, AreGreyWithoutValueOrLimit) {
  EXPECT_EQ(guardMargin("Force", 1e-6, std::nullopt, "uN").lamp.light, Light::kGrey);
  EXPECT_EQ(guardMargin("Force", std::nullopt, 1e-6, "uN").lamp.light, Light::kGrey);
  EXPECT_EQ(guardMargin("Force", std::numeric_limits<double>::quiet_NaN(), 1e-6, "uN").lamp.light, Light::kGrey);
  SessionView session;
  session.settings.depth_limit = 50e-6;
  EXPECT_EQ(depthMargin(session).lamp.light, Light::kGrey);
  session.operating = OperatingState::kEnabled;
  session.injection = InjectionState::kIndent;
  session.depth = -3e-6;  // above the contact point
  EXPECT_DOUBLE_EQ(depthMargin(session).share, 0);
  session.settings.force_limit = 10e-6;
  session.force = 9.9e-6;  // whose offset the guard does not know
  session.guard_force = 10.1e-6;
  EXPECT_EQ(forceMargin(session).lamp.light, Light::kRed);
}

TEST(DeviceLamps, HaveTheWorstTasksColourAndText) {
  DeviceLamps lamps;
  EXPECT_EQ(lamps.lamp(Device::kRig, 0).light, Light::kGrey);
  lamps.receive({"micromanipulator: cycle", 0, "runs at its rate"}, 0);
  lamps.receive({"micromanipulator: commands", 0, "holds"}, 0);
  EXPECT_EQ(lamps.lamp(Device::kRig, 1).light, Light::kGreen);
  EXPECT_EQ(lamps.lamp(Device::kRig, 1).text, "holds");
  lamps.receive({"micromanipulator: inputs", 1, "/needle/servo_cp is stale"}, 1);
  EXPECT_EQ(lamps.lamp(Device::kRig, 1).light, Light::kYellow);
  EXPECT_EQ(lamps.lamp(Device::kRig, 1).text, "/needle/servo_cp is stale");
  lamps.receive({"micromanipulator: commands", 2, "the cable is out"}, 1);
  EXPECT_EQ(lamps.lamp(Device::kRig, 1).light, Light::kRed);
  EXPECT_EQ(lamps.lamp(Device::kRig, 1).text, "the cable is out");
  lamps.receive({"display: drawing", 2, "slow"}, 1);
  EXPECT_EQ(lamps.lamp(Device::kCell, 1).light, Light::kGrey);
}

TEST(DeviceLamps, TurnRedWhenANodeFallsSilent) {
  DeviceLamps lamps;
  lamps.receive({"force_sensor: sensor", 0, "measures"}, 10);
  EXPECT_EQ(lamps.lamp(Device::kSensor, 10 + DeviceLamps::kSilence - 0.1).light, Light::kGreen);
  EXPECT_EQ(lamps.lamp(Device::kSensor, 15).light, Light::kRed);
  EXPECT_EQ(lamps.lamp(Device::kSensor, 15).text, "force_sensor is silent for 5 s");
}

TEST(Headline, SaysWhatHoldsTheNeedle) {
  SessionView session;
  session.operating = OperatingState::kPaused;
  session.injection = InjectionState::kIndent;
  session.hold_reason = "force along the pipette 2e-05 N, allowed 1.5e-05 N";
  EXPECT_EQ(headline(session).light, Light::kYellow);
  EXPECT_EQ(headline(session).text, "PAUSED: " + session.hold_reason);
  session.hold_reason.clear();
  EXPECT_EQ(headline(session).text, "PAUSED: the needle is held; Resume, Withdraw or Home");
  session.settings.mode = "manual";  // in which withdraw is refused
  EXPECT_EQ(headline(session).text, "PAUSED: the needle is held; Resume or Home");
  session.settings.mode.clear();
  session.operating = OperatingState::kEnabled;
  session.hold_reason.clear();
  session.waits = true;
  session.injection = InjectionState::kContact;
  EXPECT_EQ(headline(session).text, "ENABLED: waits for Indent or Withdraw");
  session.notice = "inject refused: it is no step from contact";
  EXPECT_EQ(headline(session).light, Light::kYellow);
}

/// Where the needle is led, an alarm elsewhere has its own lamp, and the line says what happens.
TEST(Headline, SaysWhatToMendFirstWhereTheNeedleIsNotLed) {
  SessionView session;
  session.operating = OperatingState::kDisabled;
  session.injection = InjectionState::kIdle;
  const std::string disabled = headline(session).text;
  session.hindrance = HindranceView{"micromanipulator", "no reply: is it on?", "Look at the cable.", false};
  EXPECT_EQ(headline(session).text, disabled + "; micromanipulator: no reply: is it on? - Look at the cable.");
  EXPECT_EQ(headline(session).light, Light::kGrey) << "who has disabled it may wait with a warning";
  session.hindrance->is_error = true;
  EXPECT_EQ(headline(session).light, Light::kYellow);
  session.operating = OperatingState::kEnabled;
  session.hold_reason = "no valid needle position";
  session.hindrance = HindranceView{"injection_controller", session.hold_reason, "Start the driver.", false};
  EXPECT_EQ(headline(session).text, "ENABLED: held: no valid needle position - Start the driver.");
  session.hold_reason.clear();
  session.settings.mode = "manual";
  EXPECT_EQ(headline(session).text, "ENABLED: follows the hand");
  session.operating.reset();
  EXPECT_EQ(headline(session).light, Light::kRed);
}

TEST(Headline, IsYellowWhileAGuardOrAMissingInputHoldsTheNeedle) {
  SessionView session;
  session.operating = OperatingState::kEnabled;
  session.injection = InjectionState::kIdle;
  session.settings.mode = "manual";
  for (const char* reason : {"no valid force", "no valid needle position", "the needle does not follow its set-point",
                             "depth past the touch 6e-05 m, allowed 5e-05 m: the needle may only be withdrawn"}) {
    session.hold_reason = reason;
    EXPECT_EQ(headline(session).light, Light::kYellow) << reason;
    EXPECT_EQ(headline(session).text, std::string("ENABLED: held: ") + reason);
  }
  for (const char* reason : {"", "no valid target", "no injection is under way", "homing"}) {
    session.hold_reason = reason;
    EXPECT_EQ(headline(session).light, Light::kGreen) << reason;
  }
}

TEST(CellLines, SayVerdictAndReason) {
  EXPECT_EQ(estimateLamp(std::nullopt).light, Light::kGrey);
  CellEstimateView estimate;
  estimate.verdict = "learning";
  estimate.reason = "the interval is wide";
  estimate.modulus = 5.2e3;
  estimate.low = 3e3;
  estimate.high = 9e3;
  EXPECT_EQ(estimateLamp(estimate).text, "5.20 kPa (3.00 to 9.00), learning: the interval is wide");
  EXPECT_EQ(estimateLamp(estimate).light, Light::kYellow);
  estimate.verdict = "converged";
  EXPECT_EQ(estimateLamp(estimate).light, Light::kGreen);
  estimate.verdict = "inconsistent";
  EXPECT_EQ(estimateLamp(estimate).light, Light::kRed);
  EXPECT_EQ(punctureText(estimate), "");
  estimate.puncture_depth = 31.2e-6;
  estimate.puncture_low = 27e-6;
  estimate.puncture_high = 35.5e-6;
  estimate.puncture_force = 1.3e-6;
  EXPECT_EQ(punctureText(estimate), "puncture at 31.2 um (27.0 to 35.5), 1.30 uN");
}

TEST(CellLines, SayWhatTheInjectorDoes) {
  EXPECT_EQ(injectorLamp(std::nullopt, false).light, Light::kGrey);
  EXPECT_EQ(injectorLamp(std::nullopt, true).light, Light::kRed);  // it was heard, and is silent
  InjectorView injector;
  injector.pressure = 2.46e3;
  injector.volume = 1.2e-15;
  injector.pulses = 1;
  EXPECT_EQ(injectorLamp(injector, true).text, "2.46 kPa, 1.20 pL, 1 pulse");
  injector.refusal = "busy";
  EXPECT_EQ(injectorLamp(injector, true).light, Light::kYellow);
  injector.fault = "the line is silent";
  EXPECT_EQ(injectorLamp(injector, true).light, Light::kRed);
}

}  // namespace
}  // namespace microinjection
