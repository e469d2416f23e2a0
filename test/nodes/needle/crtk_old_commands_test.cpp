// Nothing old is obeyed: commands without a stamp count by their arrival, and some arrive late.

#include <gtest/gtest.h>

#include "crtk_client.h"

namespace microinjection {
namespace {

class CrtkOldCommands : public CrtkBench {
 protected:
  /// What `command` sends arrives when the node has been frozen for so long (s).
  void freezeAnd(double seconds, const std::function<void()>& command) {
    Executive& executive = bench_.session.executive();
    executive.freeze("micromanipulator");
    command();
    bench_.run(seconds);
    executive.thaw("micromanipulator");
  }
};

/// As those of rostopic pub -1, and of the client until 1.1.
TEST_F(CrtkOldCommands, MovesWithoutAStampOfAPublisherThatLatchesAreRefused) {
  TestNode& publisher = bench_.session.addTestNode("pub");
  publisher.say("needle/move_cp", poseAt(kCrtkFar, ""), true);
  expectSaid("move_cp refused: it has no stamp and its publisher latches");
  EXPECT_TRUE(isAt(kCrtkStart));
  publisher.say("needle/servo_cp", poseAt(kCrtkFar, ""), true);
  expectSaid("needle/servo_cp: refused, it has no stamp and its publisher latches", kNeedleInputs);
  publisher.say("needle/servo_cv", velocityMessage(50e-6), true);
  expectSaid("servo_cv refused: it has no stamp and its publisher latches");
  EXPECT_TRUE(isAt(kCrtkStart));
}

TEST_F(CrtkOldCommands, ANodeThatWasFrozenObeysNoOldMove) {
  freezeAnd(3.1, [&] { client_.move(kCrtkFar); });
  expectSaid("move_cp refused: it is stale");
  bench_.run(0.3);  // for 0.2 s all that has no stamp may have waited
  EXPECT_TRUE(isAt(kCrtkStart));
}

TEST_F(CrtkOldCommands, ANodeThatWasFrozenForLessFollowsNoOldStream) {
  freezeAnd(0.15, [&] { bench_.world.sayNow("needle/servo_cp", poseAt(kCrtkFar)); });
  expectSaid("servo_cp refused: it is stale");
  bench_.session.diagnostics().clear();
  bench_.run(0.3);
  freezeAnd(0.15, [&] { client_.servo(kCrtkFar); });
  expectSaid("servo_cp refused: it is stale");
  bench_.session.diagnostics().clear();
  bench_.run(0.3);
  freezeAnd(0.15, [&] { client_.servoVelocity(50e-6); });
  expectSaid("servo_cv refused: it is stale");
  bench_.run(0.3);
  EXPECT_TRUE(isAt(kCrtkStart));
}

/// As with stamps: a command without one has a sender, too.
TEST_F(CrtkOldCommands, ASecondNodeThatCommandsIsAFault) {
  bench_.session.addTestNode("stranger").repeat("needle/servo_cp", poseMessage(0, 0, 100e-6));
  const auto servoes = [&] {
    client_.servo(kCrtkStart);
    return client_.state().state == "FAULT";
  };
  EXPECT_TRUE(bench_.until(servoes, 0.1));
  expectSaid("two nodes command the needle");
}

/// The client's last state command is latched and comes again.
TEST_F(CrtkOldCommands, ANodeThatStartsAnewObeysNothingOld) {
  EXPECT_TRUE(client_.unhome());
  EXPECT_TRUE(client_.home());
  bench_.session.executive().kill("micromanipulator");
  bench_.session.diagnostics().clear();
  bench_.session.executive().restart("micromanipulator");
  expectSaid("state_command home refused: it has no stamp and its publisher latches");
  const std::size_t since = client_.heard().size();
  client_.home();  // said again it is obeyed
  EXPECT_TRUE(bench_.until([&] { return client_.busyChanges(since) == kBusyOnce; }, 1));
}

}  // namespace
}  // namespace microinjection
