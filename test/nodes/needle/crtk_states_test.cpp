// CRTK's operating states as a client sees them, and what they do to a move under way.

#include <gtest/gtest.h>

#include "crtk_client.h"

namespace microinjection {
namespace {

class CrtkStates : public CrtkBench {};

TEST_F(CrtkStates, PauseEndsAMoveAndResumeBeginsNothing) {
  const CrtkClient::Handle handle = setOff();
  client_.command("pause");
  EXPECT_TRUE(client_.waitForState("PAUSED"));
  EXPECT_TRUE(client_.wait(handle));
  expectRests();
  const Eigen::Vector3d paused = bench_.needle();
  EXPECT_LT(paused.x(), 1e-3);
  expectSaid("move_cp of /client overridden: by pause of /client");
  client_.move(kCrtkStart);
  expectSaid("move_cp refused: PAUSED; allowed after resume");
  // The convention's table of transitions: enable is invalid in PAUSED, which it does not end.
  const std::size_t heard = client_.heard().size();
  client_.command("enable");
  expectSaid("state is PAUSED, enable is allowed in DISABLED, ENABLED, FAULT");
  ASSERT_GT(client_.heard().size(), heard) << "a state command is answered";
  for (std::size_t i = heard; i < client_.heard().size(); ++i) EXPECT_EQ(client_.heard()[i]->state, "PAUSED");
  client_.command("resume");
  EXPECT_TRUE(client_.waitForState("ENABLED"));
  expectRests();
  EXPECT_TRUE(isAt(paused)) << "what was paused does not go on by itself";
  EXPECT_TRUE(client_.wait(client_.move(kCrtkStart)));
  EXPECT_TRUE(isAt(kCrtkStart));
}

TEST_F(CrtkStates, ARefusedCommandIsOnDiagnosticsUntilOneIsObeyed) {
  const auto expectRefused = [&](const std::string& why) {
    SCOPED_TRACE(why);
    bench_.run(0.11);
    EXPECT_TRUE(contains(bench_.status(), why));
    EXPECT_EQ(bench_.level(), diagnostic_msgs::DiagnosticStatus::WARN);
  };
  bench_.run(0.11);
  const int before = bench_.refused();
  client_.command("resume");
  expectRefused("state_command resume refused: state is ENABLED, resume is allowed in PAUSED");
  client_.command("dance");
  expectRefused("state_command dance refused: \"dance\" is");
  client_.move({1, 0, 0});
  expectRefused("move_cp refused: manipulator_x = 1 m, allowed");
  EXPECT_EQ(bench_.refused(), before + 3);
  EXPECT_TRUE(client_.wait(client_.move(kCrtkStart)));
  bench_.run(0.2);
  EXPECT_EQ(bench_.level(), diagnostic_msgs::DiagnosticStatus::OK);
}

TEST_F(CrtkStates, DisableEndsAMoveAndEnableBeginsNothing) {
  setOff();
  EXPECT_TRUE(client_.disable());
  expectRests();
  const Eigen::Vector3d held = bench_.needle();
  client_.move(kCrtkStart);
  expectSaid("move_cp refused: DISABLED; allowed after enable");
  client_.command("resume");
  expectSaid("state is DISABLED, resume is allowed in PAUSED");
  EXPECT_TRUE(client_.enable());
  expectRests();
  EXPECT_TRUE(isAt(held));
}

TEST_F(CrtkStates, UnhomeEndsAMoveAndHomeAllowsTheNext) {
  EXPECT_TRUE(client_.state().is_homed);
  setOff();
  EXPECT_TRUE(client_.unhome());
  expectRests();
  const Eigen::Vector3d held = bench_.needle();
  client_.move(kCrtkStart);
  expectSaid("move_cp refused: the needle is not homed; allowed after home");
  EXPECT_TRUE(isAt(held));
  const std::size_t since = client_.heard().size();
  EXPECT_TRUE(client_.home());
  EXPECT_EQ(client_.busyChanges(since), kBusyOnce);
  EXPECT_TRUE(client_.wait(client_.move(kCrtkStart)));
  EXPECT_TRUE(isAt(kCrtkStart));
}

TEST_F(CrtkStates, AFaultIsEndedByEnableOrDisable) {
  const CrtkClient::Handle handle = setOff();
  bench_.inject("error:4");
  EXPECT_TRUE(client_.waitForState("FAULT"));
  EXPECT_TRUE(client_.wait(handle));
  expectRests();
  for (const std::string command : {"pause", "resume", "home"}) {
    client_.command(command);
    expectSaid("state is FAULT, " + command + " is allowed in");
  }
  EXPECT_EQ(client_.state().state, "FAULT");
  EXPECT_TRUE(client_.enable());
  EXPECT_TRUE(client_.wait(client_.move(kCrtkStart)));
  EXPECT_TRUE(isAt(kCrtkStart));
  bench_.inject("error:4");
  EXPECT_TRUE(client_.waitForState("FAULT"));
  EXPECT_TRUE(client_.disable());
}

}  // namespace
}  // namespace microinjection
