#include "operation/console/automatic_injection.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

SessionView readySession() {
  SessionView session;
  session.operating = OperatingState::kEnabled;
  session.injection = InjectionState::kIdle;
  session.settings.mode = "automatic";
  return session;
}

TEST(AutomaticInjection, IsOfferedWhereTheControllerWouldBegin) {
  EXPECT_EQ(offerInjection(readySession(), true, false).refusal, "");
  EXPECT_EQ(offerInjection(readySession(), false, false).refusal, "/controller/inject does not answer");
  EXPECT_EQ(offerInjection(readySession(), true, true).refusal, "the injection is under way");
  SessionView session = readySession();
  session.operating = OperatingState::kDisabled;
  EXPECT_NE(offerInjection(session, true, false).refusal.find("state is DISABLED"), std::string::npos);
  session = readySession();
  session.injection = InjectionState::kIndent;
  EXPECT_NE(offerInjection(session, true, false).refusal.find("the needle is in indent"), std::string::npos);
}

TEST(AutomaticInjection, ShowsItsProgress) {
  EXPECT_EQ(progressText({"approach", 1, 2, 0, 0, 1.2}), "approach, layer 1 of 2, 0.00 uN, 1 s");
  EXPECT_EQ(progressText({"inject", 3, 2, 12.34e-6, 1.2e-6, 7}), "inject, 12.3 um deep, 1.20 uN, 7 s");
  EXPECT_EQ(progressText({"indent", 0, 0, 3e-6, 1e-6, 2}), "indent, 3.0 um deep, 1.00 uN, 2 s");
}

TEST(AutomaticInjection, ReportsItsOutcome) {
  EXPECT_EQ(outcomeText("injected", "", 2, 5e-15), "injected: 5.0 pL through 2 membranes");
  EXPECT_EQ(outcomeText("injected", "", 1, 5e-15), "injected: 5.0 pL through 1 membrane");
  EXPECT_EQ(outcomeText("punctured", "", 1, 0), "punctured");
  EXPECT_EQ(outcomeText("guard", "depth past the touch", 0, 0), "guard: depth past the touch");
  for (const char* reached : {"injected", "punctured", "indented"}) EXPECT_TRUE(isReached(reached));
  for (const char* missed : {"preempted", "guard", "fault", "refused", "not_punctured"})
    EXPECT_FALSE(isReached(missed));
}

}  // namespace
}  // namespace microinjection
