#include "fault_session.h"
#include "holder_world.h"

namespace microinjection {
namespace {

struct HolderFault {
  NodeFault fault;
  const char* state;
};
void PrintTo(const HolderFault& fault, std::ostream* out) {
  PrintTo(fault.fault, out);
  *out << " in " << fault.state;
}

/// An injection of a cell that is held by suction. Whenever the holder, or who commands it, is killed or frozen, the
/// pressure stays; and the needle, which does not depend on it, ends its way in good order.
class DeadHolder : public testing::TestWithParam<HolderFault> {
 protected:
  static constexpr double kHeld = -1500;  // Pa

  DeadHolder() {
    session().start();
    holder_.setBy(commander_, kHeld);
    session_.runIntoState(GetParam().state, 0.05);
    EXPECT_EQ(holder_.state().target, kHeld);
  }
  VirtualSession& session() { return session_.session(); }

  FaultSession session_{{"cell:=" + testFile("scenes/injected_oocyte.yaml"), "model:=live", "hand.device:=none",
                         "sensor.source:=none", "display.markers:=false", "holder:=sim", "holder_rig.name:=sim",
                         "overrides:={rig: {start_height: 32e-6}, injection_controller: {detection: {noise_samples: "
                         "50}, goal: {depth: 15e-6, margin: 0.5e-6, pulse: {pressure: 20e3, duration: 0.3}}, "
                         "motion: {stab_speed: 20e-6, indent_speed: 20e-6, approach_speed: 40e-6}}}"}};
  TestNode& commander_ = session_.session().addTestNode("commander");
  HolderWorld holder_{session_.session()};
};

TEST_P(DeadHolder, TheHolderItself) {
  session_.strike("holder", GetParam().fault);
  session().run(0.05);
  const std::size_t told = holder_.states().count();
  session_.runIntoState("idle", 0.1);
  EXPECT_EQ(holder_.states().count(), told) << "its pressure is no longer told";
  if (GetParam().fault == NodeFault::kKill) return;
  session().executive().thaw("holder");
  session().run(2);
  EXPECT_NEAR(holder_.state().source_pressure, kHeld, 1);
  EXPECT_EQ(holder_.state().state, "ENABLED");
}

TEST_P(DeadHolder, WhoCommandsIt) {
  session_.strike("commander", GetParam().fault);
  session_.runIntoState("idle", 2);
  EXPECT_NEAR(holder_.state().source_pressure, kHeld, 1);
  EXPECT_NEAR(holder_.state().pressure, kHeld, 1);
}

TEST_P(DeadHolder, ItsManipulator) {
  session_.strike("holder_rig", GetParam().fault);
  session_.runIntoState("idle", 0.1);
  EXPECT_NEAR(holder_.state().source_pressure, kHeld, 1);
}

INSTANTIATE_TEST_SUITE_P(
    InAnyState, DeadHolder,
    testing::Values(HolderFault{NodeFault::kKill, "approach"}, HolderFault{NodeFault::kKill, "indent"},
                    HolderFault{NodeFault::kKill, "inject"}, HolderFault{NodeFault::kKill, "withdraw"},
                    HolderFault{NodeFault::kFreeze, "indent"}, HolderFault{NodeFault::kFreeze, "inject"}));

}  // namespace
}  // namespace microinjection
