#include <gtest/gtest.h>

#include "cell_microinjection/LoopState.h"
#include "nodes/injection/injection_chain.h"

namespace microinjection {
namespace {

/// A rig, and what keeps it from following its stream while the controller indents by itself. With `its_` before it, of
/// the node that moves an external rig.
struct RigHold {
  std::string rig, by;
};
void PrintTo(const RigHold& hold, std::ostream* out) { *out << hold.rig << ' ' << hold.by; }

class RigHoldTest : public testing::TestWithParam<RigHold> {
 protected:
  RigHoldTest() {
    world().hear<cell_microinjection::LoopState>("controller/loop_state");
    world().publisher<cell_microinjection::StringStamped>("needle/state_command");
  }
  TestNode& world() { return chain_.session.world(); }
  void begin() {
    if (GetParam().by == "its_disable") chain_.session.stage()->state = "DISABLED";
    if (GetParam().by == "its_silence") chain_.session.stage()->inject("silence:3", chain_.session.now());
    if (GetParam().by == "its_restart") chain_.session.executive().kill("my_rig");
    if (isOfItsNode()) return;
    if (GetParam().by == "restart") return chain_.session.executive().kill("micromanipulator");
    world().command("needle/state_command", GetParam().by);
  }
  void end() {
    if (GetParam().by == "restart") {
      chain_.session.executive().restart("micromanipulator");
      chain_.session.run(1);
    }
    if (GetParam().by == "its_restart") {
      chain_.session.stage()->first_state = "DISABLED";
      chain_.session.executive().restart("my_rig");
      chain_.session.run(1);
    }
    world().command("needle/state_command", GetParam().by == "pause" ? "resume" : "enable");
  }
  static bool isOfItsNode() { return GetParam().by.rfind("its_", 0) == 0; }
  std::string controllerState() {
    return world().hear<cell_microinjection::OperatingState>("controller/operating_state").newest()->state;
  }
  std::string holdReason() {
    return world().hear<cell_microinjection::LoopState>("controller/loop_state").newest()->hold_reason;
  }

  InjectionChain chain_{{"rig.name:=" + GetParam().rig}};
};

TEST_P(RigHoldTest, PausesTheInjectionAndNothingLeapsAfterIt) {
  chain_.say("approach");
  ASSERT_TRUE(chain_.reaches("indent"));
  ASSERT_TRUE(chain_.session.until([&] { return chain_.status().depth > 1e-6; }));
  begin();
  chain_.session.run(3);
  const bool is_dead = GetParam().by == "restart" || GetParam().by == "its_restart" || GetParam().by == "its_silence";
  EXPECT_EQ(controllerState(), "PAUSED");
  EXPECT_NE(holdReason().find(is_dead ? "no valid needle position" : "the micromanipulator "), std::string::npos)
      << holdReason();
  end();
  chain_.session.run(0.5);
  const Eigen::Vector3d held = chain_.resting();
  chain_.session.run(3);
  EXPECT_LT((chain_.needle() - held).norm(), 0.1e-6) << "nothing moves before a word to the controller";
  EXPECT_LT(chain_.cell().indentation, 6e-6);
  EXPECT_EQ(chain_.injector().pulses, 0u);
  EXPECT_FALSE(chain_.injector().busy);
  EXPECT_EQ(controllerState(), "PAUSED");
  chain_.say("withdraw");
  EXPECT_TRUE(chain_.session.until([&] { return chain_.status().state == "idle"; }, 30)) << chain_.status();
}

std::vector<RigHold> holds() {
  std::vector<RigHold> all;
  for (const char* rig :
       {"sim", "emulated_zaber", "emulated_mp285", "emulated_scientifica", "emulated_eppendorf", "external"})
    for (const char* by : {"disable", "stop", "pause", "restart"}) all.push_back({rig, by});
  for (const char* by : {"its_disable", "its_silence", "its_restart"}) all.push_back({"external", by});
  return all;
}
INSTANTIATE_TEST_SUITE_P(Rigs, RigHoldTest, testing::ValuesIn(holds()),
                         [](const auto& hold) { return hold.param.rig + "_" + hold.param.by; });

}  // namespace
}  // namespace microinjection
