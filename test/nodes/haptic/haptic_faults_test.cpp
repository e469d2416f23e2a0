// Each haptic device, emulated behind its driver's topics, leads the needle, with each fault of its driver.

#include <gtest/gtest.h>

#include <fstream>

#include "benchmark/emulated_haptic/emulated_haptic_node.h"
#include "cell_microinjection/CellContact.h"
#include "nodes/faults/faulty_topic.h"

namespace microinjection {
namespace {

class HapticFaultsTest : public testing::TestWithParam<FaultyDevice> {
 protected:
  HapticFaultsTest() {
    TestNode& world = session_.world();
    world.hear<geometry_msgs::PoseStamped>("needle/true_cp");
    world.repeat("cell/predicted_cf", wrenchMessage(0, 0, 0));
    world.repeat("cell/contact", cell_microinjection::CellContact());
    const std::string motion = session_.folder() / "motion.csv";
    // A device's place is the needle's, a stick's is its speed. No hand holds it quite still.
    std::ofstream(motion) << "time_s,x_m,y_m,z_m,clutch,phase\n0,0,0,0,0,rest\n0.2,0,0,0,0,rest\n0.21,0,0,"
                          << (isStick() ? -0.0098 : 0) << ",0,lead\n4.2,0,0," << (isStick() ? -0.01 : -0.032)
                          << ",0,lead\n";
    YAML::Node parameters;
    parameters["kind"] = GetParam().device;
    parameters["start_delay"] = 0.2;
    parameters["motion"] = motion;
    session_.executive().add("emulated_haptic", makeNode<EmulatedHapticNode>(), parameters);
    for (const char* node : {"micromanipulator", "injection_controller", "haptic_bridge"})
      session_.add(node, "{diagnostic_period: 0.05}");
    if (GetParam().device != "crtk") session_.add("haptic_device", "{diagnostic_period: 0.05}");
  }

  bool isStick() const { return GetParam().device == "joy" || GetParam().device == "spacenav"; }
  double speed() const { return isStick() ? 13e-6 : 8e-6; }  // m/s, of the needle

  static std::vector<std::string> overrides() {
    const std::string& device = GetParam().device;
    const bool is_old_dvrk = device == "dvrk_2_0";
    std::vector<std::string> all{"sensor.source:=none", "injector:=none", "display.markers:=false",
                                 "hand.device:=" + (device == "crtk" ? "external"
                                                    : is_old_dvrk    ? "dvrk"
                                                                     : device)};
    if (is_old_dvrk) all.emplace_back("hand.position_type:=transform");
    return all;
  }
  double needle() {
    return session_.world().hear<geometry_msgs::PoseStamped>("needle/true_cp").newest()->pose.position.z;
  }
  template <typename Message>
  void strike(const std::string& topic, double leap = 20e-3) {
    const auto faulty = std::make_shared<FaultyTopic<Message>>(session_, topic);
    faulty->strike(GetParam().fault, leap);
    faulty_ = faulty;
  }
  void strike() {
    const std::string& device = GetParam().device;
    using geometry_msgs::PoseStamped;
    if (isStick()) return strike<sensor_msgs::Joy>(device == "joy" ? "/joy" : "/spacenav/joy");
    if (device == "omni") return strike<OmniState>("/phantom/state", 20);        // mm
    if (device == "geomagic") return strike<PoseStamped>("/Geomagic/pose", 20);  // mm
    if (device == "force_dimension") return strike<PoseStamped>("/Falcon00/measured_cp");
    if (device == "dvrk") return strike<PoseStamped>("/MTMR/measured_cp");
    if (device == "dvrk_2_0") return strike<geometry_msgs::TransformStamped>("/MTMR/measured_cp");
    strike<PoseStamped>(device == "falcon" ? "/falcon/measured_cp" : "/haptic/measured_cp");
  }
  std::string reason() const {
    switch (GetParam().fault) {
      case DeviceFault::kFrozen:
        return " repeats ";
      case DeviceFault::kJumps:
        return "the hand ";  // was too fast: rest; behind a driver of 100 Hz it is fast until it rests
      case DeviceFault::kSecondSender:
        return "is sent by two nodes";
      default:
        return "no valid hand position";
    }
  }
  bool said() const {
    for (const char* name :
         {"haptic_device: inputs", "haptic_device: device", "haptic_bridge: inputs", "haptic_bridge: loop"}) {
      if (session_.diagnostics().ever(name, reason())) return true;
    }
    return false;
  }

  VirtualSession session_{overrides()};
  std::shared_ptr<void> faulty_;
};

TEST_P(HapticFaultsTest, LeadTheNeedleNoFurtherAndAreSaid) {
  const auto now = [&] { return session_.now().toSec(); };
  session_.run(0.35);
  const double rest = needle();
  const auto moves = [&](double way) { return session_.until([&] { return rest - needle() > way; }, 2); };
  ASSERT_TRUE(moves(1e-6)) << session_.diagnostics().text("haptic_bridge: loop");
  session_.diagnostics().clear();  // an arm of dVRK waits for its settings first
  ASSERT_TRUE(moves(3e-6));
  const double struck = now(), from = needle();
  EXPECT_FALSE(said());
  session_.diagnostics().clear();
  strike();
  const DeviceFault fault = GetParam().fault;
  // A stick that repeats its end may be held there by a hand: for so long (s).
  const double known = fault == DeviceFault::kFrozen && isStick() ? 1.6 : 0.2;
  double farthest = 0, low = INFINITY, high = -INFINITY;
  session_.until(
      [&] {
        farthest = std::max(farthest, std::abs(needle() - from));
        if (now() - struck < known + 0.1) return false;
        low = std::min(low, needle());
        high = std::max(high, needle());
        return false;
      },
      fault == DeviceFault::kFrozen ? 2.3 : 1);
  EXPECT_TRUE(said()) << session_.diagnostics().text("haptic_device: device") << "; "
                      << session_.diagnostics().text("haptic_device: inputs")
                      << "\nbridge: " << session_.diagnostics().text("haptic_bridge: loop") << "; "
                      << session_.diagnostics().text("haptic_bridge: inputs");
  if (fault == DeviceFault::kJumps) {  // held once, it leads on from where it is
    EXPECT_LE(farthest, 1e-6 + 1.2 * speed());
    return;
  }
  EXPECT_LE(farthest, 1e-6 + known * speed());
  EXPECT_LT(high - low, 0.05e-6) << "it does not rest";
}

/// But a leap of a stick, which is a hand's word as any other: the needle's speed is bounded.
std::vector<FaultyDevice> allFaultyHapticDevices() {
  std::vector<FaultyDevice> all;
  for (const std::string& device : emulatedDrivers()) {
    for (int fault = 0; fault < static_cast<int>(DeviceFault::kLine); ++fault) {
      const bool is_leap = static_cast<DeviceFault>(fault) == DeviceFault::kJumps;
      if (!is_leap || (device != "joy" && device != "spacenav"))
        all.push_back({device, static_cast<DeviceFault>(fault)});
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Matrix, HapticFaultsTest, testing::ValuesIn(allFaultyHapticDevices()), faultyName);

}  // namespace
}  // namespace microinjection
