// Each haptic device, emulated behind its driver's topics, does a whole injection: the needle follows while the
// dead-man is held down, each time anew, and what the device renders on the hand is the force on the needle.

#include <gtest/gtest.h>
#include <sensor_msgs/TimeReference.h>

#include <algorithm>

#include "benchmark/emulated_haptic/emulated_haptic_node.h"
#include "cell_microinjection/CellState.h"
#include "cell_microinjection/InjectionStatus.h"
#include "cell_microinjection/InjectorState.h"
#include "nodes/runtime/conversions.h"
#include "virtual_session.h"

namespace microinjection {
namespace {

using cell_microinjection::InjectionStatus;
using cell_microinjection::StringStamped;
using sensor_msgs::TimeReference;
constexpr double kContractGain = 2e5;  // config/haptic_bridge.yaml

std::vector<std::string> contractOverrides(const std::string& driver) {
  std::vector<std::string> overrides{"cell:=" + testFile("scenes/injected_oocyte.yaml"), "model:=live",
                                     "display.markers:=false"};
  const bool is_old_dvrk = driver == "dvrk_2_0";
  overrides.push_back("hand.device:=" + (driver == "crtk" ? "external" : is_old_dvrk ? "dvrk" : driver));
  if (is_old_dvrk) overrides.push_back("hand.position_type:=transform");
  return overrides;
}

class HapticContractTest : public testing::TestWithParam<std::string> {
 protected:
  HapticContractTest() {
    YAML::Node parameters;
    parameters["kind"] = GetParam();
    parameters["start_delay"] = 0.2;
    parameters["motion"] = testFile(isStick() ? "scenes/whole_injection_stick.csv" : "scenes/whole_injection.csv");
    session_.executive().add("emulated_haptic", makeNode<EmulatedHapticNode>(), parameters);
    hear<StringStamped>("virtual_hand/phase");
    hear<InjectionStatus>("controller/injection_state");
    hear<geometry_msgs::PoseStamped>("needle/measured_cp");
    hear<geometry_msgs::WrenchStamped>("cell/predicted_cf");
    hear<geometry_msgs::WrenchStamped>("emulated_haptic/measured_cf");
    hear<cell_microinjection::CellState>("cell/state");
    hear<cell_microinjection::InjectorState>("injector/state");
    hear<TimeReference>("haptic/force_trace");
    hear<TimeReference>("needle/setpoint_trace");
    session_.start();
  }

  /// A joystick sets a speed, and renders no force.
  bool isStick() const { return GetParam() == "joy" || GetParam() == "spacenav"; }
  template <typename Message>
  Probe<Message>& hear(const std::string& topic) {
    return session_.world().hear<Message>(topic);
  }
  template <typename Message>
  const Message& newest(const std::string& topic) {
    return *hear<Message>(topic).newest();
  }
  Eigen::Vector3d needle() { return toVector(newest<geometry_msgs::PoseStamped>("needle/measured_cp").pose.position); }
  Eigen::Vector3d tipForce() { return forceOn("cell/predicted_cf"); }
  Eigen::Vector3d handForce() { return forceOn("emulated_haptic/measured_cf"); }
  const cell_microinjection::CellState& cell() { return newest<cell_microinjection::CellState>("cell/state"); }
  unsigned pulses() { return newest<cell_microinjection::InjectorState>("injector/state").pulses; }

  /// The states of the injection, each once in a row.
  std::vector<std::string> states() {
    std::vector<std::string> states;
    for (const auto& status : hear<InjectionStatus>("controller/injection_state").all()) {
      if (status->state != "idle" && (states.empty() || states.back() != status->state))
        states.push_back(status->state);
    }
    return states;
  }
  bool was(const std::string& state) {
    const auto all = states();
    return std::find(all.begin(), all.end(), state) != all.end();
  }
  std::string phase() {
    const auto* told = hear<StringStamped>("virtual_hand/phase").newest();
    return told ? told->string : "";
  }
  /// To the begin of a phase of the hand's motion.
  void runTo(const std::string& next) {
    ASSERT_TRUE(session_.until([&] { return phase() == next; }, 15))
        << "phase " << next << " never came; the bridge: " << session_.diagnostics().text("haptic_bridge: loop")
        << "; the injection: " << testing::PrintToString(states());
  }

  void expectThatTheDeadManLeads();
  void expectTheForceOfTheCell();
  void expectTracesOfTheLoop();
  void expectAnInjection();
  void expectTheNeedleOutOfTheCell();

  VirtualSession session_{contractOverrides(GetParam())};
  Eigen::Vector3d rest_ = Eigen::Vector3d::Zero();  ///< m, of the needle

 private:
  Eigen::Vector3d forceOn(const std::string& topic) {
    return toVector(newest<geometry_msgs::WrenchStamped>(topic).wrench.force);
  }
};

void HapticContractTest::expectThatTheDeadManLeads() {
  runTo("rest");
  session_.run(2e-3);
  rest_ = needle();
  runTo("away");
  const double stroke = rest_.z() - needle().z();
  EXPECT_GT(stroke, 2e-6) << "the needle follows when the dead-man is held down first";
  EXPECT_LT(stroke, 6e-6);
  session_.run(0.1);
  const Eigen::Vector3d held = needle();
  runTo("taken up");
  EXPECT_LT((needle() - held).norm(), 5e-9) << "let go, the needle stays";
  runTo("indent");
  EXPECT_GT(held.z() - needle().z(), 15e-6) << "and follows when it is held down again";
}

/// What the hand feels before the membrane gives way is the force on the tip, in its direction.
void HapticContractTest::expectTheForceOfTheCell() {
  double on_hand = 0, expected = 0, sideways = 0;
  int count = 0;
  while (phase() == "indent" && !was("punctured")) {
    session_.run(1e-3);
    if (!cell().in_contact || tipForce().z() < 0.3e-6) continue;
    ++count;
    on_hand += handForce().z();
    expected += kContractGain * tipForce().z();
    sideways = std::max(sideways, handForce().head<2>().norm());
  }
  EXPECT_GT(count, 100) << "the needle pressed the cell";
  if (isStick()) {
    EXPECT_EQ(on_hand, 0);
    return;
  }
  // The mean, since the hand's own motion is damped (passivity, driver) and the device may be slow.
  EXPECT_NEAR(on_hand / expected, 1, 0.25);
  EXPECT_LT(sideways, 0.1 * expected / count);
  if (GetParam() == "crtk") expectTracesOfTheLoop();
}

/// They name what was measured before.
void HapticContractTest::expectTracesOfTheLoop() {
  const std::pair<const char*, const char*> traces[] = {{"haptic/force_trace", "needle"},
                                                        {"needle/setpoint_trace", "hand"}};
  for (const auto& [topic, source] : traces) {
    const auto& trace = newest<TimeReference>(topic);
    EXPECT_EQ(trace.source, source);
    EXPECT_LE(trace.time_ref, trace.header.stamp);
    EXPECT_LT((trace.header.stamp - trace.time_ref).toSec(), 0.05);
  }
}

void HapticContractTest::expectAnInjection() {
  runTo("inject");
  const unsigned before = pulses();
  auto until_now = states();
  // The stick's button is down as soon as the phase begins.
  until_now.erase(std::remove(until_now.begin(), until_now.end(), "inject"), until_now.end());
  ASSERT_FALSE(until_now.empty());
  EXPECT_EQ(until_now.back(), "punctured");
  if (!isStick()) session_.world().command("controller/state_command", "inject");
  runTo("retract");
  EXPECT_TRUE(was("inject"));
  EXPECT_EQ(pulses(), before + 1);
}

void HapticContractTest::expectTheNeedleOutOfTheCell() {
  runTo("done");
  const auto all = states();
  const std::vector<std::string> since(std::find(all.begin(), all.end(), "indent"), all.end());
  EXPECT_EQ(since, std::vector<std::string>({"indent", "punctured", "inject", "punctured", "withdraw", "approach"}));
  EXPECT_TRUE(cell().punctured);
  EXPECT_FALSE(cell().in_contact);
  EXPECT_LT(handForce().norm(), 0.05);
  EXPECT_GT(needle().z(), rest_.z() - 35e-6);
}

TEST_P(HapticContractTest, AWholeInjection) {
  ASSERT_NO_FATAL_FAILURE(expectThatTheDeadManLeads());
  ASSERT_NO_FATAL_FAILURE(expectTheForceOfTheCell());
  ASSERT_NO_FATAL_FAILURE(expectAnInjection());
  ASSERT_NO_FATAL_FAILURE(expectTheNeedleOutOfTheCell());
}

INSTANTIATE_TEST_SUITE_P(Drivers, HapticContractTest, testing::ValuesIn(emulatedDrivers()),
                         [](const auto& driver) { return driver.param; });

}  // namespace
}  // namespace microinjection
