// Each rig that a session can have, led by a hand, with each fault of its pose on the way to the others, and of its
// line.

#include <gtest/gtest.h>

#include <algorithm>

#include "cell_microinjection/CellContact.h"
#include "cell_microinjection/ManipulatorAbilities.h"
#include "cell_microinjection/OperatingState.h"
#include "faulty_topic.h"
#include "hardware/devices/driver_registry.h"
#include "led_hand.h"

namespace microinjection {
namespace {

class RigFaultsTest : public testing::TestWithParam<FaultyDevice> {
 protected:
  static constexpr double kSpeed = 20e-6, kWay = 20e-6;  // m/s, m, of the needle up and down
  static constexpr double kLimit = 1e-6 + 0.2 * kSpeed;  // m, of the needle after the fault
  static constexpr double kKnown = 0.5;                  // s after the fault, by which the needle rests for good

  RigFaultsTest() {
    TestNode& world = session_.world();
    world.hear<cell_microinjection::ManipulatorAbilities>("needle/abilities");
    world.hear<geometry_msgs::PoseStamped>("needle/servo_cp");
    world.repeat("cell/predicted_cf", wrenchMessage(0, 0, 0));
    world.repeat("cell/contact", cell_microinjection::CellContact());
    for (const char* node : {"micromanipulator", "injection_controller", "haptic_bridge"})
      session_.add(node, "{diagnostic_period: 0.05}");
    poses_.emplace(session_, "/needle/measured_cp");
  }

  static std::vector<std::string> overrides() {
    return {"rig.name:=" + GetParam().device,
            "hand.device:=external",
            "hand.require_operator:=false",
            "sensor.source:=none",
            "injector:=none",
            "display.markers:=false"};
  }
  bool isEnabled(const std::string& topic) {
    const auto* state = session_.world().hear<cell_microinjection::OperatingState>(topic).newest();
    return state && state->state == "ENABLED";
  }
  /// m, the height as the rig knows it; not a number: it does not know.
  double needle() const {
    const auto* pose = poses_->sent();
    return pose && !pose->header.stamp.isZero() ? pose->pose.position.z : NAN;
  }
  double setpoint() {  ///< m, of its height
    return session_.world().hear<geometry_msgs::PoseStamped>("needle/servo_cp").newest()->pose.position.z;
  }
  void lead() {
    ASSERT_TRUE(session_.until([&] {
      return isEnabled("needle/operating_state") && isEnabled("controller/operating_state") && std::isfinite(needle());
    }));
    session_.run(0.1);
    const double start = needle();
    hand_.emplace(session_);
    session_.run(0.3);
    hand_->sway(kWay / LedHand::kScale, kSpeed / LedHand::kScale);
    const auto moves = [&](double way) { return session_.until([&] { return start - needle() > way; }, 3); };
    ASSERT_TRUE(moves(2e-6));
    session_.diagnostics().clear();  // a device on a line waits for its answers first
    ASSERT_TRUE(moves(5e-6));
  }
  void strike() {
    poses_->strike(GetParam().fault, 30e-6);
    if (GetParam().fault != DeviceFault::kLine) return;
    if (session_.stage()) return session_.stage()->inject("silence:2", session_.now());
    session_.world().command("needle/emulated_fault", "silence:2");
  }
  std::string reason() const {
    switch (GetParam().fault) {
      case DeviceFault::kFrozen:
        return " repeats ";
      case DeviceFault::kJumps:
        return "from its set-point";
      case DeviceFault::kSecondSender:
        return "is sent by two nodes";
      default:
        return "no valid needle position";
    }
  }
  bool said() const {
    for (const char* name : {"injection_controller: inputs", "injection_controller: control", "haptic_bridge: inputs",
                             "haptic_bridge: loop"}) {
      if (session_.diagnostics().ever(name, reason())) return true;
    }
    return false;
  }

  VirtualSession session_{overrides()};
  std::optional<FaultyTopic<geometry_msgs::PoseStamped>> poses_;
  std::optional<LedHand> hand_;
};

TEST_P(RigFaultsTest, MoveTheNeedleNoFurtherAndAreSaid) {
  lead();
  if (HasFatalFailure()) return;
  const double struck = session_.now().toSec(), from = needle(), asked = setpoint();
  EXPECT_FALSE(said());
  session_.diagnostics().clear();
  strike();
  const bool is_blind = GetParam().fault == DeviceFault::kLine;
  const auto& rig = *session_.world().hear<cell_microinjection::ManipulatorAbilities>("needle/abilities").newest();
  // A pose may stand as long as the rig may take for a set-point.
  const double times = GetParam().fault == DeviceFault::kFrozen
                           ? rig.latency + rig.command_interval + rig.reading_interval + rig.stop_time
                           : 0;
  const double known = kKnown + times;
  double farthest = 0, low = INFINITY, high = -INFINITY;
  session_.until(
      [&] {
        const double z = needle(), since = session_.now().toSec() - struck;
        hand_->silent = hand_->silent || (is_blind && since > 1);
        if (!std::isfinite(z)) return false;
        farthest = std::max({farthest, asked - z, z - from});
        if (since < known) return false;
        low = std::min(low, z);
        high = std::max(high, z);
        return false;
      },
      is_blind ? 4 : known + 0.7);
  ASSERT_TRUE(std::isfinite(low)) << "the rig does not know its place any more";
  EXPECT_LE(farthest, kLimit + times * kSpeed + rig.resolution);
  EXPECT_LT(high - low, 0.05e-6 + 1.5 * rig.resolution) << "it does not rest";
  EXPECT_TRUE(said()) << "controller: " << session_.diagnostics().text("injection_controller: control") << "; "
                      << session_.diagnostics().text("injection_controller: inputs")
                      << "\nbridge: " << session_.diagnostics().text("haptic_bridge: loop") << "; "
                      << session_.diagnostics().text("haptic_bridge: inputs");
  const auto& felt = session_.world().hear<geometry_msgs::WrenchStamped>("haptic/servo_cf").newest()->wrench.force;
  EXPECT_EQ(toVector(felt).norm(), 0);
}

std::vector<FaultyDevice> allFaultyRigs() {
  std::vector<std::string> names{"sim", "external"};
  for (const DriverEntry& rig : driverEntries()) names.push_back("emulated_" + rig.name);
  std::vector<FaultyDevice> all;
  for (const std::string& name : names) {
    for (int fault = 0; fault <= static_cast<int>(DeviceFault::kLine); ++fault) {
      const bool has_no_line = name == "sim" && static_cast<DeviceFault>(fault) == DeviceFault::kLine;
      if (!has_no_line) all.push_back({name, static_cast<DeviceFault>(fault)});
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Matrix, RigFaultsTest, testing::ValuesIn(allFaultyRigs()), faultyName);

}  // namespace
}  // namespace microinjection
