#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <tuple>

#include "hardware/devices/driver_registry.h"
#include "hardware/injector/injector_registry.h"
#include "nodes/injection/injection_chain.h"

namespace microinjection {
namespace {

using actionlib_msgs::GoalStatus;
using cell_microinjection::InjectResult;
using States = std::vector<std::string>;

constexpr double kZona = 1.2e-6;  // N, where it gives way, of injected_oocyte.yaml

/// Rig and injector of a session.
struct Devices {
  std::string rig, injector;
  friend std::ostream& operator<<(std::ostream& out, const Devices& devices) {
    return out << devices.rig << " and " << devices.injector;
  }
};

/// A whole injection, from the approach to the withdrawal, with each kind of rig and injector.
class WholeInjectionTest : public testing::TestWithParam<Devices> {
 protected:
  InjectResult result() {
    EXPECT_TRUE(chain_.session.until([&] { return client_.ended(); }, 30)) << chain_.status();
    return client_.ended() ? *client_.result() : InjectResult();
  }

  /// The balance pressure of a FemtoJet is such that little flows without a pulse, as that of the others.
  static std::vector<std::string> overrides() {
    std::vector<std::string> overrides{"rig.name:=" + GetParam().rig, "injector:=" + GetParam().injector};
    if (GetParam().injector == "emulated_femtojet") overrides.emplace_back("overrides.injector.balance:=500");
    return overrides;
  }

  InjectionChain chain_{overrides()};
  ActionClient<cell_microinjection::InjectAction> client_{chain_.session.world(), "controller/inject"};
  const Eigen::Vector3d start_ = chain_.resting();
  const cell_microinjection::InjectorState before_ = chain_.injector();
};

TEST_P(WholeInjectionTest, GoesThroughTheZonaInjectsAndComesOut) {
  auto goal = punctureGoal();
  if (GetParam().injector == "emulated_arduino") goal.duration = 0.6;  // s, it takes 0.4 s to hear the end
  client_.send(goal);
  const InjectResult done = result();
  EXPECT_EQ(client_.state(), GoalStatus::SUCCEEDED);
  EXPECT_EQ(done.outcome, "injected");
  EXPECT_EQ(done.reason, "");
  chain_.session.run(0.3);
  chain_.expectOut(start_);
  EXPECT_EQ(chain_.passed(), (States{"approach", "contact", "indent", "punctured", "inject", "punctured", "withdraw"}));
  EXPECT_EQ(done.punctures, 1);
  EXPECT_NEAR(done.puncture_force / kZona, 1, 0.05);
  EXPECT_GE(done.max_depth, done.puncture_depth + 1.9e-6);
  EXPECT_TRUE(chain_.cell().punctured);
  EXPECT_EQ(chain_.cell().holes.size(), 1u);
  EXPECT_FALSE(chain_.cell().inside);
  EXPECT_EQ(chain_.injector().pulses, before_.pulses + 1);
  // What the pressure's fall after the pulse pushes out is not the pulse's.
  EXPECT_NEAR(done.volume / (chain_.injector().volume - before_.volume), 1, 0.1);
  EXPECT_GT(done.volume, 0);
}

/// The simulated rig, each that is emulated, and another's node, with the simulated injector; the simulated rig with
/// each that is emulated.
std::vector<Devices> allDevices() {
  std::vector<Devices> all{{"sim", "simulated"}};
  for (const DriverEntry& rig : driverEntries()) all.push_back({"emulated_" + rig.name, "simulated"});
  all.push_back({"external", "simulated"});
  for (const Injector& injector : injectors()) all.push_back({"sim", "emulated_" + injector.name});
  return all;
}
std::string nameOf(const testing::TestParamInfo<Devices>& info) { return info.param.rig + "_" + info.param.injector; }

INSTANTIATE_TEST_SUITE_P(Devices, WholeInjectionTest, testing::ValuesIn(allDevices()), nameOf);

using CancelledInThePulseTest = WholeInjectionTest;

TEST_P(CancelledInThePulseTest, StopsThePulseAndWithdraws) {
  auto goal = punctureGoal();
  goal.duration = 30;
  client_.send(goal);
  // An injector on a serial line is busy before, too, until it is set up.
  const auto flows = [&] { return chain_.status().state == "inject" && chain_.injector().busy; };
  ASSERT_TRUE(chain_.session.until(flows, 30)) << chain_.status();
  chain_.session.run(0.1);
  ASSERT_TRUE(chain_.injector().busy);
  EXPECT_EQ(chain_.status().state, "inject");
  client_.cancel();
  chain_.session.run(2e-3);
  EXPECT_EQ(chain_.status().state, "withdraw");
  // A device on a serial line answers two commands meanwhile.
  const double patience = GetParam().injector == "simulated" ? 5e-3 : 0.15;
  EXPECT_TRUE(chain_.session.until([&] { return !chain_.injector().busy; }, patience));
  EXPECT_EQ(chain_.status().state, "withdraw");
  const InjectResult done = result();
  EXPECT_EQ(client_.state(), GoalStatus::PREEMPTED);
  EXPECT_EQ(done.outcome, "preempted");
  EXPECT_EQ(done.punctures, 1);
  chain_.expectOut(start_);
  EXPECT_EQ(chain_.injector().pulses, before_.pulses);
}

INSTANTIATE_TEST_SUITE_P(Devices, CancelledInThePulseTest,
                         testing::Values(Devices{"sim", "simulated"}, Devices{"sim", "emulated_voltage"}), nameOf);

using TwoMembranesTest = WholeInjectionTest;

TEST_P(TwoMembranesTest, AreToldEachAndThePulseComesBehindTheLast) {
  auto goal = punctureGoal();
  goal.layers = 2;
  client_.send(goal);
  ASSERT_TRUE(chain_.session.until([&] { return chain_.status().punctures > 0; }, 30)) << chain_.status();
  EXPECT_EQ(chain_.status().punctures, 1u);
  ASSERT_TRUE(chain_.session.until([&] { return chain_.status().punctures == 2; })) << chain_.status();
  EXPECT_EQ(chain_.status().state, "punctured");
  // The cell tells its state 60 times a second.
  EXPECT_TRUE(chain_.session.until([&] { return chain_.cell().layers_punctured == 2; }, 0.02));
  EXPECT_EQ(chain_.injector().pulses, before_.pulses);
  const InjectResult done = result();
  EXPECT_EQ(client_.state(), GoalStatus::SUCCEEDED);
  EXPECT_EQ(done.outcome, "injected");
  EXPECT_EQ(done.punctures, 2);
  chain_.expectOut(start_);
  EXPECT_EQ(chain_.passed(), (States{"approach", "contact", "indent", "punctured", "indent", "punctured", "inject",
                                     "punctured", "withdraw"}));
  std::vector<std::tuple<std::string, int, int>> told;
  for (const auto& feedback : client_.feedback()) told.emplace_back(feedback.state, feedback.layer, feedback.layers);
  const auto has = [&](const char* state, int layer) {
    return std::find(told.begin(), told.end(), std::tuple(std::string(state), layer, 2)) != told.end();
  };
  EXPECT_TRUE(has("indent", 1));
  EXPECT_TRUE(has("indent", 2));
  EXPECT_TRUE(has("inject", 3));
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end(), [](const auto& one, const auto& other) {
    return std::get<1>(one) < std::get<1>(other);
  })) << "layers only go up";
}

INSTANTIATE_TEST_SUITE_P(Devices, TwoMembranesTest, testing::Values(Devices{"sim", "simulated"}), nameOf);

}  // namespace
}  // namespace microinjection
