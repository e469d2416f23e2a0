#include "operation/readiness/remedies.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace microinjection {
namespace {

const char* const kPage = R"(# Troubleshooting

## It does not enable

- `no reply: is it on?`, `NAME answers: is it the right port?` (status `device`): look at
  the [cable](rig.md#cable) and its `baud` rate.
- `its size is wrong`

`it is PAUSED`: then send

    rostopic pub /command resume

**The network.** `others can reach this machine through NAME`: ROS 1 has **no** authentication.

### It holds

1. `no valid hand position`. The adapter says why: `the stick repeats one deflection` (let go of it).
2. `the tip is N m ahead of the last solution, allowed N`: wait.
)";

TEST(Remedies, AreReadFromThePage) {
  const Remedies remedies(kPage);
  const auto text = [&](const std::string& reason) {
    const auto found = remedies.of(reason);
    return found ? found->section + ": " + found->text : "none";
  };
  const std::string cable = "It does not enable: Look at the cable and its baud rate.";
  EXPECT_EQ(text("Zaber: no reply: is it on?"), cable);
  EXPECT_EQ(text("X-MCB2 answers: is it the right port?"), cable);
  EXPECT_EQ(text("its size is wrong"), "It does not enable: ");
  EXPECT_EQ(text("others can reach this machine through eth0; go on"),
            "It does not enable: ROS 1 has no authentication.");
  EXPECT_EQ(text("the tip is 2e-05 m ahead of the last solution, allowed 1e-05"), "It holds: Wait.");
  EXPECT_EQ(text("no valid hand position").substr(0, 31), "It holds: The adapter says why:");
  EXPECT_EQ(text("the stick repeats one deflection").substr(0, 32), "It holds: no valid hand position");
  EXPECT_EQ(text("it is PAUSED"), "It does not enable: Then send rostopic pub /command resume");
  EXPECT_EQ(text("something else"), "none");
  EXPECT_EQ(text("device"), "none");
}

TEST(Remedies, AnOddPageIsNoError) {
  for (const char* page : {"", "#", "   \n#\n- \n- `", "1. `a b c d e f`", "    code\n"})
    EXPECT_FALSE(Remedies(page).of("something else"));
}

TEST(Remedies, OfThePageThatIsBuiltIn) {
  const Remedies& remedies = Remedies::builtIn();
  EXPECT_GT(remedies.patterns().size(), 200U);
  for (const char* reason :
       {"no valid needle position",
        "the operator is not present",
        "clutch is pressed",
        "no injection is under way",
        "Zaber: connected, no reply yet",
        "the tip is deeper than the cell was prepared for: withdraw it",
        "/needle/measured_cp is stale",
        "state is PAUSED, enable is allowed in DISABLED, ENABLED, FAULT",
        "two nodes command the needle: a and b; allowed after enable",
        "needle held: DISABLED",
        "needle held: PAUSED",
        "the node vision has not started yet",
        "two nodes command the holder: /a and /b; the pressure is kept; allowed after enable",
        "the pressure is kept: its commander /a is silent",
        "the holder is DISABLED: its pressure is kept",
        "set_pressure refused: it is stale",
        "set_pressure refused: pressure = nan Pa, allowed [-20000, 20000] Pa",
        "set_pressure refused: state is FAULT",
        "draw_limit is reached: nothing more is drawn in",
        "the holder's pressure is not known: its device was not told one yet",
        "set_balance refused: draw_limit = 2e-15 m^3 is reached; push out what was drawn in first, or reset",
        "two nodes command the holding pipette: /a and /b; allowed after enable",
        "the place of the other manipulator is not known: it is an obstacle where it was last",
        "/focus/measured_js is silent"}) {
    const auto found = remedies.of(reason);
    ASSERT_TRUE(found) << reason;
    EXPECT_FALSE(found->text.empty()) << reason;
    EXPECT_EQ(found->text.find_first_of("`["), std::string::npos) << found->text;
  }
}

/// A pattern is of itself, whatever N, NAME and TOPIC are.
TEST(Remedies, EveryPatternFindsARemedy) {
  const Remedies& remedies = Remedies::builtIn();
  for (std::string pattern : remedies.patterns()) {
    for (std::size_t at; (at = pattern.find("...")) != std::string::npos;) pattern.replace(at, 3, "any thing");
    EXPECT_TRUE(remedies.of("node: " + pattern)) << pattern;
  }
}

}  // namespace
}  // namespace microinjection
