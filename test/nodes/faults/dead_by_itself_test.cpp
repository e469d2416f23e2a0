#include "fault_session.h"

namespace microinjection {
namespace {

/// The controller injects by itself, with a pulse that would take half a minute. Whichever node is killed or frozen:
/// within the time-outs of config/ the needle rests and no pulse flows.
class InjectionSession : public FaultSession {
 public:
  InjectionSession()
      : FaultSession({"cell:=" + testFile("scenes/injected_oocyte.yaml"), "model:=live", "hand.device:=none",
                      "sensor.source:=none", "display.markers:=false",
                      "overrides:={rig: {start_height: 32e-6}, injection_controller: {detection: {noise_samples: 50}, "
                      "goal: {depth: 15e-6, margin: 0.5e-6, pulse: {pressure: 20e3, duration: 30.0}}, "
                      "motion: {stab_speed: 20e-6, indent_speed: 20e-6, approach_speed: 40e-6}}}"}) {
    session().start();
  }
  /// Some seconds into a state; of withdraw: given up while it indents.
  void runInto(const std::string& state, double seconds) {
    if (state != "withdraw") return runIntoState(state, seconds);
    runIntoState("indent", seconds);
    session().world().command("controller/state_command", "withdraw");
    runIntoState(state, seconds);
  }
};

struct OwnFault {
  NodeFault fault;
  const char* state;
  double into;  // s
};
void PrintTo(const OwnFault& fault, std::ostream* out) {
  PrintTo(fault.fault, out);
  *out << " in " << fault.state;
}

class DeadByItself : public testing::TestWithParam<OwnFault> {
 protected:
  DeadByItself() { session_.runInto(GetParam().state, GetParam().into); }
  double strike(const std::string& node) {
    const double struck = session_.strike(node, GetParam().fault);
    session_.session().run(0.24);
    return struck;
  }
  bool withdraws() const { return std::string(GetParam().state) == "withdraw"; }

  InjectionSession session_;
};

TEST_P(DeadByItself, Controller) {
  const double struck = strike("injection_controller");
  InjectionSession::expectRests(session_.needle(), struck, InjectionSession::kStopTime);
}

TEST_P(DeadByItself, Micromanipulator) {
  const double struck = strike("micromanipulator");
  InjectionSession::expectRests(session_.setpoint(), struck, InjectionSession::kInputs);
}

TEST_P(DeadByItself, CellSimulatorWithoutWhichItOnlyWithdraws) {
  const double struck = strike("cell_simulator");
  if (!withdraws()) {
    InjectionSession::expectRests(session_.needle(), struck, InjectionSession::kInputs + InjectionSession::kStopTime);
    return;
  }
  session_.runIntoState("idle", 0.1);
  const Track needle = session_.needle().since(struck);
  for (std::size_t i = 1; i < needle.values.size(); ++i)
    ASSERT_GT(needle.values[i].z(), needle.values[i - 1].z() - InjectionSession::kStill) << "deeper";
  EXPECT_GT(needle.values.back().z(), InjectionSession::kStart - InjectionSession::kStill) << "it is out";
}

INSTANTIATE_TEST_SUITE_P(InAnyState, DeadByItself,
                         testing::Values(OwnFault{NodeFault::kKill, "approach", 0.1},
                                         OwnFault{NodeFault::kKill, "indent", 0.06},
                                         OwnFault{NodeFault::kKill, "withdraw", 0.06},
                                         OwnFault{NodeFault::kFreeze, "indent", 0.06},
                                         OwnFault{NodeFault::kFreeze, "withdraw", 0.06}));

class DeadInAPulse : public testing::TestWithParam<NodeFault> {
 protected:
  static constexpr double kPulseTimeout = 0.2;  // s, of a pulse that the controller holds
  static constexpr double kBalance = 545;       // Pa

  DeadInAPulse() { session_.runInto("inject", 0.1); }
  double strike(const std::string& node) {
    const double struck = session_.strike(node, GetParam());
    session_.session().run(0.32);
    return struck;
  }
  /// Within the time-out and one step of the injector.
  void expectPulseEnds(double struck, double within) {
    const auto& states = session_.injector();
    double busy = -INFINITY;
    for (std::size_t i = 0; i < states.count(); ++i) {
      if (states.all()[i]->busy) busy = states.arrivals()[i].toSec() - struck;
    }
    EXPECT_GT(busy, 0);
    EXPECT_LE(busy, within + 5e-3);
    EXPECT_NEAR(states.newest()->pressure, kBalance, 1);
  }
  /// All the time since, and in the cell.
  void expectNeedleStays(double struck) {
    EXPECT_LT(session_.needle().since(struck).span(), InjectionSession::kStill);
    EXPECT_LT(session_.needle().values.back().z(), 28e-6);
  }

  InjectionSession session_;
};

TEST_P(DeadInAPulse, EndsWithTheControllerThatAskedForIt) {
  const double struck = strike("injection_controller");
  expectPulseEnds(struck, kPulseTimeout);
  expectNeedleStays(struck);
}

TEST_P(DeadInAPulse, EndsWhereThePlaceOfTheNeedleIsNotKnown) {
  expectPulseEnds(strike("micromanipulator"), InjectionSession::kInputs);
}

TEST_P(DeadInAPulse, EndsWhereTheForceIsNotKnown) {
  const double struck = strike("cell_simulator");
  expectPulseEnds(struck, InjectionSession::kInputs);
  expectNeedleStays(struck);
}

TEST_P(DeadInAPulse, InjectorThatDiesLeavesTheNeedleWhereItIs) { expectNeedleStays(strike("injector")); }

INSTANTIATE_TEST_SUITE_P(KillAndFreeze, DeadInAPulse, testing::Values(NodeFault::kKill, NodeFault::kFreeze));

}  // namespace
}  // namespace microinjection
