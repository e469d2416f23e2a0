#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "cell_microinjection/InjectionPulse.h"
#include "cell_microinjection/InjectionStatus.h"
#include "cell_microinjection/InjectorState.h"
#include "cell_microinjection/ManipulatorAbilities.h"
#include "virtual_session.h"

namespace microinjection {
namespace {

using cell_microinjection::InjectionPulse;
using cell_microinjection::InjectionStatus;
using cell_microinjection::InjectorState;
using cell_microinjection::StringStamped;
using geometry_msgs::PoseStamped;
using geometry_msgs::WrenchStamped;

constexpr char kTarget[] = "teleop/servo_cp", kNeedle[] = "needle/measured_cp", kForce[] = "cell/predicted_cf";

/// The controller alone. The test is the hand's bridge, a needle that is where it is sent, the cell and the injector.
class ControllerTrustTest : public testing::Test {
 protected:
  static constexpr char kStatus[] = "injection_controller: control";

  ControllerTrustTest() {
    world_.hear<PoseStamped>("needle/servo_cp");
    world_.hear<InjectionStatus>("controller/injection_state");
    world_.hear<InjectionPulse>("injector/pulse");
    world_.hear<StringStamped>("injector/stop");
    world_.publisher<StringStamped>("controller/state_command");
    world_.repeat<InjectorState>("injector/state", [this] {
      InjectorState state;
      state.busy = static_cast<unsigned char>(busy_);
      return std::optional(state);
    });
    sayGood();
    session_.add("injection_controller", "{auto_enable: true, diagnostic_period: 0.1}");
    session_.run(0.3);
  }
  void SetUp() override { ASSERT_EQ(session_.diagnostics().text(kStatus), "the needle follows"); }

  /// A target, a needle that is where it was sent, a force.
  void sayGood() {
    world_.repeat<PoseStamped>(kTarget, [this] { return std::optional(poseMessage(0, 0, target_)); });
    world_.repeat<PoseStamped>(kNeedle, [this] { return std::optional(poseMessage(0, 0, setpoint())); });
    world_.repeat<WrenchStamped>(kForce, [this] { return std::optional(wrenchMessage(0, 0, force_())); });
  }
  double setpoint() {
    const auto* const message = world_.hear<PoseStamped>("needle/servo_cp").newest();
    return message ? message->pose.position.z : 60e-6;
  }
  const InjectionStatus& injection() { return *world_.hear<InjectionStatus>("controller/injection_state").newest(); }

  /// `spoil` changes what one of the topics says.
  void expectHeld(const std::function<void()>& spoil, const std::string& why) {
    SCOPED_TRACE(why);
    spoil();
    session_.run(0.06);  // past the time-out of 50 ms
    const double held = setpoint();
    target_ -= 10e-6;
    session_.run(0.3);
    EXPECT_EQ(setpoint(), held);
    ASSERT_NE(session_.diagnostics().of(kStatus), nullptr);
    EXPECT_NE(session_.diagnostics().of(kStatus)->level, diagnostic_msgs::DiagnosticStatus::OK);
    EXPECT_NE(session_.diagnostics().text(kStatus).find(why), std::string::npos)
        << session_.diagnostics().text(kStatus);
    // Back again: what the target did meanwhile must not be caught up with, what it does now must be followed.
    sayGood();
    session_.run(0.3);
    EXPECT_NEAR(setpoint(), held, 1e-12);
    target_ -= 2e-6;
    session_.run(0.3);
    EXPECT_NEAR(setpoint(), held - 2e-6, 1e-12);
  }

  VirtualSession session_{{"hand.device:=external", "display.markers:=false"}};
  TestNode& world_ = session_.world();
  double target_ = 60e-6;                              // m
  std::function<double()> force_ = [] { return 0.; };  // N along the needle
  bool busy_ = false;
};

TEST_F(ControllerTrustTest, WithoutAValidTargetTheNeedleIsHeld) {
  expectHeld([&] { world_.silence(kTarget); }, "no valid target");
  expectHeld([&] { world_.repeatInvalid<PoseStamped>(kTarget); }, "no valid target");
  expectHeld([&] { world_.repeat(kTarget, poseMessage(0, 0, NAN)); }, "no valid target");
  expectHeld([&] { world_.repeat(kTarget, poseMessage(0, 0, 0, "camera")); }, "no valid target");
}

TEST_F(ControllerTrustTest, WithoutAValidForceTheNeedleIsHeld) {
  expectHeld([&] { world_.silence(kForce); }, "no valid force");
  expectHeld([&] { world_.repeat(kForce, wrenchMessage(0, 0, INFINITY)); }, "no valid force");
}

TEST_F(ControllerTrustTest, WithoutAValidPositionTheNeedleIsHeld) {
  expectHeld([&] { world_.silence(kNeedle); }, "no valid needle position");
  expectHeld([&] { world_.repeat(kNeedle, poseMessage(NAN, 0, 0)); }, "no valid needle position");
}

TEST_F(ControllerTrustTest, ATargetThatLeapsIsNotFollowed) {
  const double held = setpoint();
  target_ -= 150e-6;
  session_.run(0.3);
  EXPECT_EQ(setpoint(), held);
  EXPECT_NE(session_.diagnostics().text(kStatus).find("allowed 0.0001 m"), std::string::npos)
      << session_.diagnostics().text(kStatus);
}

TEST_F(ControllerTrustTest, ThroughTheMembraneTheWordInjectIsOnePulseAndDisableStopsIt) {
  const double surface = setpoint() - 3e-6;
  bool through = false;
  force_ = [&] {  // a membrane of 0.2 N/m that fails 5 um deep
    const double depth = std::max(0.0, surface - setpoint());
    through = through || depth > 5e-6;
    return through ? 0.1e-6 : 0.2 * depth;
  };
  for (int i = 0; i < 20000 && injection().state != "punctured"; ++i) {
    target_ -= 5e-9;  // 5 um/s
    session_.run(1e-3);
  }
  ASSERT_EQ(injection().state, "punctured");
  EXPECT_EQ(injection().punctures, 1u);
  auto& pulses = world_.hear<InjectionPulse>("injector/pulse");
  auto& stops = world_.hear<StringStamped>("injector/stop");
  EXPECT_EQ(pulses.count(), 0u);
  world_.command("controller/state_command", "inject");
  session_.run(2e-3);
  ASSERT_EQ(pulses.count(), 1u);
  const InjectionPulse pulse = *pulses.newest();
  const YAML::Node goal = session_.parameters("injection_controller")["goal"]["pulse"];
  EXPECT_EQ(pulse.pressure, goal["pressure"].as<double>());
  EXPECT_EQ(pulse.duration, goal["duration"].as<double>());
  busy_ = true;
  session_.run(0.1);
  EXPECT_EQ(pulses.newest()->id, pulse.id);
  EXPECT_EQ(injection().state, "inject");
  EXPECT_EQ(stops.count(), 0u);
  world_.command("controller/state_command", "disable");
  session_.run(2e-3);
  EXPECT_EQ(stops.count(), 1u);
  EXPECT_EQ(injection().state, "idle");
}

TEST_F(ControllerTrustTest, AbilitiesThatNoRigHasAreIgnored) {
  const auto limitAfter = [&](double speed, double latency, double interval = 0) {
    cell_microinjection::ManipulatorAbilities abilities;
    abilities.speed = speed;
    abilities.latency = latency;
    abilities.command_interval = interval;
    world_.say("needle/abilities", abilities);
    session_.run(0.2);
    return std::stod(session_.diagnostics().value(kStatus, "speed limit (m/s)"));
  };
  const double by_config = session_.parameters("injection_controller")["speed_limit"].as<double>();
  EXPECT_NEAR(limitAfter(1, 0.001), by_config, 1e-10);
  EXPECT_NEAR(limitAfter(44e-6, 0), 44e-6, 1e-10);
  constexpr double kInfinite = INFINITY, kNoNumber = NAN;
  for (const double bad : {kInfinite, kNoNumber, 1e300}) {
    EXPECT_NEAR(limitAfter(bad, 0), 44e-6, 1e-10) << bad << " m/s";
    EXPECT_NEAR(limitAfter(100e-6, bad), 44e-6, 1e-10) << bad << " s";
  }
  EXPECT_NEAR(limitAfter(100e-6, -5, 5), 44e-6, 1e-10);
  EXPECT_NEAR(limitAfter(100e-6, 5, -5), 44e-6, 1e-10);
  EXPECT_NEAR(limitAfter(1, 0.001), by_config, 1e-10);
}

}  // namespace
}  // namespace microinjection
