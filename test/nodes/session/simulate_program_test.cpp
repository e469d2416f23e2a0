// The program simulate as its users run it.

#include "commands/command_test.h"

namespace microinjection {
namespace {

class SimulateProgram : public CommandTest {
 protected:
  SimulateProgram() : CommandTest(MICROINJECTION_SIMULATE, "simulate") {}

  static void expectText(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text << " has no " << part;
  }
};

TEST_F(SimulateProgram, RunsASessionForADurationAndLeavesItsFiles) {
  const Outcome result = run("--duration 1.25 --record here");
  EXPECT_EQ(result.status, 0) << result.err;
  expectText(result.out, "1.25 s of the session in ");
  expectText(result.out, "; recorded in " + directory_ + "here\n");
  for (const char* name : {"force_depth.csv", "summary.yaml", "session.bag"}) {
    EXPECT_GT(std::filesystem::file_size(directory_ + "here/" + name), 0u) << name;
  }
}

TEST_F(SimulateProgram, TellsTheOutcomeOfAnInjection) {
  const Outcome result = run("hand.device=none --quiet");  // as session takes it
  EXPECT_EQ(result.status, 0) << result.err;
  expectText(result.out, " times real time; injection: injected\n");
}

TEST_F(SimulateProgram, FailsWhenTheSessionIsNotDoneInTime) {
  const Outcome result = run("default --limit 1.5");
  EXPECT_EQ(result.status, 3);
  expectText(result.err, "simulate: neither the hand nor the injection was done within 1.5 s\n");
}

TEST_F(SimulateProgram, RefusesWhatNeedsAPersonOrADisplay) {
  const Outcome result = run("hand.device:=keyboard display.rviz:=true");
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.out, "");
  expectText(result.err, "simulate: argument: hand/device = keyboard: needs a live session");
  expectText(result.err, "argument: display/rviz = true: needs a live session");
}

TEST_F(SimulateProgram, RefusesArgumentsThatAreNone) {
  for (const char* arguments : {"--speed 3", "--duration -1", "--limit nan", "nowhere", "hand.devise:=none"}) {
    const Outcome result = run(arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_EQ(result.err.find("simulate: "), 0u) << result.err;
  }
  EXPECT_EQ(run("--help").status, 0);
}

}  // namespace
}  // namespace microinjection
