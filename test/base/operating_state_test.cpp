#include "base/operating_state.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace microinjection {
namespace {

using State = OperatingState;
using Command = StateCommand;

TEST(OperatingStates, LeadWhereTheConventionsTableSays) {
  struct Row {
    State state;
    std::vector<std::optional<State>> next;  // of enable, disable, pause, resume
  };
  const std::vector<Row> table = {{State::kDisabled, {State::kEnabled, State::kDisabled, std::nullopt, std::nullopt}},
                                  {State::kEnabled, {State::kEnabled, State::kDisabled, State::kPaused, std::nullopt}},
                                  {State::kPaused, {std::nullopt, State::kDisabled, State::kPaused, State::kEnabled}},
                                  {State::kFault, {State::kEnabled, State::kDisabled, std::nullopt, std::nullopt}}};
  const Command commands[] = {Command::kEnable, Command::kDisable, Command::kPause, Command::kResume};
  for (const Row& row : table) {
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(after(row.state, commands[i]), row.next[i]) << toText(row.state) << " " << toText(commands[i]);
    }
  }
}

TEST(OperatingStates, HomeIsForEnabledAndUnhomeForAll) {
  for (const State state : {State::kDisabled, State::kEnabled, State::kPaused, State::kFault}) {
    EXPECT_EQ(after(state, Command::kHome).has_value(), state == State::kEnabled) << toText(state);
    EXPECT_EQ(after(state, Command::kUnhome), state);
  }
}

TEST(OperatingStates, HaveTheConventionsWords) {
  EXPECT_STREQ(toText(State::kPaused), "PAUSED");
  for (const std::string word : {"enable", "disable", "pause", "resume", "home", "unhome"}) {
    ASSERT_TRUE(stateCommandOf(word)) << word;
    EXPECT_EQ(toText(*stateCommandOf(word)), word);
  }
  EXPECT_FALSE(stateCommandOf("stop"));
  EXPECT_FALSE(stateCommandOf("Enable"));
}

TEST(OperatingStates, ARefusalSaysWhereACommandIsAllowed) {
  EXPECT_EQ(refusalOf(State::kPaused, Command::kEnable),
            "state is PAUSED, enable is allowed in DISABLED, ENABLED, FAULT");
  EXPECT_EQ(refusalOf(State::kEnabled, Command::kResume), "state is ENABLED, resume is allowed in PAUSED");
}

}  // namespace
}  // namespace microinjection
