#include "operation/control/injection_state.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>

namespace microinjection {
namespace {

// Written once more, by name: each change of the table has to be made twice, on purpose.
const std::map<std::pair<std::string, std::string>, std::string> kExpected = {
    {{"idle", "start"}, "approach"},
    {{"approach", "touch"}, "contact"},
    {{"approach", "withdraw"}, "withdraw"},
    {{"contact", "lost"}, "approach"},
    {{"contact", "indent"}, "indent"},
    {{"contact", "puncture"}, "punctured"},
    {{"contact", "withdraw"}, "withdraw"},
    {{"indent", "puncture"}, "punctured"},
    {{"indent", "withdraw"}, "withdraw"},
    {{"punctured", "indent"}, "indent"},
    {{"punctured", "puncture"}, "punctured"},
    {{"punctured", "inject"}, "inject"},
    {{"punctured", "withdraw"}, "withdraw"},
    {{"inject", "injected"}, "punctured"},
    {{"inject", "withdraw"}, "withdraw"},
    {{"withdraw", "touch"}, "contact"},
    {{"withdraw", "withdraw"}, "withdraw"},
    {{"withdraw", "out"}, "idle"},
    {{"indent", "aspirate"}, "aspirate"},
    {{"aspirate", "puncture"}, "punctured"},
    {{"aspirate", "indent"}, "indent"},
    {{"aspirate", "withdraw"}, "withdraw"},
    {{"idle", "hold"}, "hold"},
    {{"hold", "start"}, "approach"},
    {{"hold", "withdraw"}, "withdraw"},
    {{"idle", "release"}, "release"},
    {{"withdraw", "release"}, "release"},
    {{"release", "out"}, "idle"},
    {{"hold", "out"}, "idle"},
    {{"release", "withdraw"}, "withdraw"},
};

const std::pair<InjectionEvent, const char*> kEvents[] = {
    {InjectionEvent::kStart, "start"},       {InjectionEvent::kTouch, "touch"},
    {InjectionEvent::kLost, "lost"},         {InjectionEvent::kIndent, "indent"},
    {InjectionEvent::kPuncture, "puncture"}, {InjectionEvent::kInject, "inject"},
    {InjectionEvent::kInjected, "injected"}, {InjectionEvent::kWithdraw, "withdraw"},
    {InjectionEvent::kOut, "out"},           {InjectionEvent::kFail, "fail"},
    {InjectionEvent::kReset, "reset"},       {InjectionEvent::kAspirate, "aspirate"},
    {InjectionEvent::kHold, "hold"},         {InjectionEvent::kRelease, "release"},
};

TEST(InjectionState, EachEventInEachState) {
  for (const InjectionState state : kInjectionStates) {
    for (const auto& [event, name] : kEvents) {
      const std::string from = toText(state), what = name;
      std::string expected = "none";
      if (kExpected.count({from, what}) != 0) expected = kExpected.at({from, what});
      if (what == "fail") expected = "fault";
      if (what == "reset") expected = "idle";
      const auto next = after(state, event);
      EXPECT_EQ(next ? toText(*next) : "none", expected) << from << ", " << what;
    }
  }
}

TEST(InjectionState, FromEveryStateInTheCellThereIsAWayOut) {
  for (const char* name : {"approach", "contact", "indent", "aspirate", "punctured", "inject", "withdraw"}) {
    for (const InjectionState state : kInjectionStates) {
      if (toText(state) != std::string(name)) continue;
      const auto next = after(state, InjectionEvent::kWithdraw);
      ASSERT_TRUE(next) << name;
      EXPECT_EQ(after(*next, InjectionEvent::kOut), InjectionState::kIdle) << name;
    }
  }
}

}  // namespace
}  // namespace microinjection
