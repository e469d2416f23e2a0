#include "hand_session.h"

namespace microinjection {
namespace {

/// A hand leads the needle. Whichever node is killed or frozen: within the time-outs of config/ the needle rests and
/// the force on the hand is zero. The way back is the same to every time-out, since nobody knows of the hand's phases.
struct HandFault {
  NodeFault fault;
  const char* phase;
  double into;  // s
};
void PrintTo(const HandFault& fault, std::ostream* out) {
  PrintTo(fault.fault, out);
  *out << " in " << fault.phase;
}

class DeadByHand : public testing::TestWithParam<HandFault> {
 protected:
  /// `record`: s afterwards.
  void strike(const std::string& node, double record = 0.24) {
    session_.runIntoPhase(GetParam().phase, GetParam().into);
    struck_ = session_.strike(node, GetParam().fault);
    session_.session().run(record);
  }
  void expectNeedleRests(double within) {
    HandSession::expectRests(session_.needle(), struck_, within + HandSession::kStopTime);
  }
  /// In the approach it was never felt.
  void expectForceEnds(double within, double earlier = 0) {
    if (std::string(GetParam().phase) == "approach") return HandSession::expectNoForce(session_.force());
    HandSession::expectForceEnds(session_.force(), struck_, within, earlier);
  }

  HandSession session_{{}};
  double struck_ = 0;
};

TEST_P(DeadByHand, Hand) {
  strike("virtual_hand");
  expectNeedleRests(0);
  expectForceEnds(HandSession::kInputs, HandSession::sooner(GetParam().fault));
}

TEST_P(DeadByHand, Bridge) {
  strike("haptic_bridge");
  expectNeedleRests(0);
}

TEST_P(DeadByHand, Controller) {
  strike("injection_controller", 0.4);
  expectNeedleRests(0);
  expectForceEnds(HandSession::kController, 0.1);  // its state comes each 0.1 s
}

TEST_P(DeadByHand, Micromanipulator) {
  strike("micromanipulator");
  HandSession::expectRests(session_.setpoint(), struck_, HandSession::kInputs);
  expectForceEnds(HandSession::kInputs);
}

TEST_P(DeadByHand, CellSimulator) {
  strike("cell_simulator");
  expectNeedleRests(HandSession::kInputs);
  expectForceEnds(HandSession::kInputs);
}

INSTANTIATE_TEST_SUITE_P(InAnyPhase, DeadByHand,
                         testing::Values(HandFault{NodeFault::kKill, "approach", 0.06},
                                         HandFault{NodeFault::kKill, "indent", 0.2},
                                         HandFault{NodeFault::kFreeze, "indent", 0.2}));

/// Faults in one place of the motion.
class FaultByHand : public testing::TestWithParam<NodeFault> {};

TEST_P(FaultByHand, BridgeLeavesNoForceOnTheHand) {
  HandSession session({});
  session.runIntoPhase("hold", 0.06);
  const double struck = session.strike("haptic_bridge", GetParam());
  session.session().run(0.24);
  const Track hand = session.hand();
  const auto at = std::find_if(hand.times.rbegin(), hand.times.rend(), [&](double time) { return time <= struck; });
  const double pressed = hand.values[static_cast<std::size_t>(hand.times.rend() - at) - 1].z() - -8e-3;
  EXPECT_GT(pressed, 1e-4) << "the hand does not yield to the force";
  // Its acceleration leaps when the force does; else it changes little from step to step.
  double largest = 0, leap = 0;
  for (std::size_t i = 3; i < hand.times.size(); ++i) {
    if (hand.times[i] < struck + 0.005 || hand.times[i] > struck + 0.1) continue;
    const auto z = [&](std::size_t back) { return hand.values[i - back].z(); };
    const double third = std::abs(z(0) - 3 * z(1) + 3 * z(2) - z(3));
    if (third > largest) leap = hand.times[i] - struck;
    largest = std::max(largest, third);
  }
  EXPECT_NEAR(leap, 0.05, 2 * HandSession::kTick) << "force_timeout of the virtual hand";
  EXPECT_NEAR(hand.values.back().z(), -8e-3, 0.1 * pressed);
}

TEST_P(FaultByHand, SensorWhoseForceIsUsed) {
  HandSession::Options options;
  options.sensor = true;
  options.source = "measured";
  HandSession session(options);
  session.runIntoPhase("indent", 0.2);
  const double struck = session.strike("force_sensor", GetParam());
  session.session().run(0.24);
  HandSession::expectRests(session.needle(), struck, HandSession::kInputs + HandSession::kStopTime);
  HandSession::expectForceEnds(session.force(), struck, HandSession::kInputs);
}

TEST_P(FaultByHand, WhatTheLoopDoesNotNeedLeavesItAsItIs) {
  HandSession::Options options;
  options.sensor = options.injector = true;
  HandSession session(options);
  session.runIntoPhase("indent", 0.05);
  for (const char* node : {"force_sensor", "injector"}) {
    SCOPED_TRACE(node);
    const double struck = session.strike(node, GetParam());
    session.session().run(0.11);
    session.expectGoesOn(struck);
  }
}

INSTANTIATE_TEST_SUITE_P(KillAndFreeze, FaultByHand, testing::Values(NodeFault::kKill, NodeFault::kFreeze));

/// A node that wakes up finds old messages and knows what was when it was frozen.
struct Sleeper {
  const char* node;
  double ahead;  // m, of the needle: where the set-point was when the controller noticed
};
void PrintTo(const Sleeper& sleeper, std::ostream* out) { *out << sleeper.node; }

class ThawedNode : public testing::TestWithParam<Sleeper> {};

TEST_P(ThawedNode, ActsOnNothingOldAndFollowsFromWhereItIs) {
  HandSession session({});
  const auto height = [&] { return session.needle().values.back().z(); };
  session.runIntoPhase("approach", 0.06);
  session.strike(GetParam().node, NodeFault::kFreeze);
  session.session().run(0.3);  // the hand is 4 um deeper, indents, and goes on by 17 nm each millisecond
  const double rests = height();
  session.session().executive().thaw(GetParam().node);
  session.session().run(0.005);
  const double woken = height();
  EXPECT_LT(rests - woken, GetParam().ahead + 5 * 17e-9);
  session.session().run(0.05);
  EXPECT_NEAR(woken - height(), 50 * 17e-9, 5 * 17e-9);
}

// A driver that wakes up goes on to the set-point, which the controller let go on for 0.05 s by 20 um/s.
INSTANTIATE_TEST_SUITE_P(OfTheLoop, ThawedNode,
                         testing::Values(Sleeper{"injection_controller", 0}, Sleeper{"micromanipulator", 1e-6},
                                         Sleeper{"haptic_bridge", 0}));

}  // namespace
}  // namespace microinjection
