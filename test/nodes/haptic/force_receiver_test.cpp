// A hand is followed only while the node that tells its position subscribes to the force on it. Another node that does
// so, a watchdog or a recorder, renders nothing.

#include <gtest/gtest.h>
#include <std_msgs/Bool.h>

#include "cell_microinjection/InjectionStatus.h"
#include "cell_microinjection/OperatingState.h"
#include "nodes/haptic/geomagic_messages.h"
#include "nodes/haptic/omni_messages.h"
#include "virtual_session.h"

namespace microinjection {
namespace {

using geometry_msgs::PoseStamped;
using geometry_msgs::WrenchStamped;

template <typename Message>
void tell(TestNode& device, const std::string& topic) {
  device.repeat(topic, Message());
}
template <>
void tell<PoseStamped>(TestNode& device, const std::string& topic) {
  device.repeat(topic, poseMessage(0, 0, 0, "device"));
}

/// Hears a topic until the handle ends.
template <typename Message>
std::shared_ptr<Probe<Message>> listen(TestNode& node, const std::string& topic) {
  return std::make_shared<Probe<Message>>(node.bus(), topic);
}

struct ReceivingDevice {
  const char* kind;      // of config/haptic
  const char* position;  // topic
  void (*tell_position)(TestNode&, const std::string&);
  const char* force;  // topic
  std::shared_ptr<void> (*listen_to_force)(TestNode&, const std::string&);
};
void PrintTo(const ReceivingDevice& device, std::ostream* out) { *out << device.kind; }
template <typename Position, typename Force>
ReceivingDevice receivingDevice(const char* kind, const char* position, const char* force) {
  return {kind, position, tell<Position>, force,
          [](TestNode& node, const std::string& topic) -> std::shared_ptr<void> { return listen<Force>(node, topic); }};
}

/// The device is a node of the test, "device". "world" hears the force, too, but tells no position.
class FollowedDevice {
 public:
  explicit FollowedDevice(const ReceivingDevice& kind)
      : kind_(kind),
        session_({std::string("hand.device:=") + kind.kind,
                  // Of devices that may have no such button; for the others it is the default.
                  std::string("hand.require_operator:=") + (isExternal() ? "false" : "true")}),
        device_(session_.addTestNode("device")),
        status_(isExternal() ? "haptic_bridge: loop" : "haptic_device: device"),
        other_(kind.listen_to_force(session_.world(), kind.force)) {
    followed();
    kind.tell_position(device_, kind.position);
    if (isExternal()) addRig();
    session_.add(isExternal() ? "haptic_bridge" : "haptic_device", "{diagnostic_period: 0.1}");
  }

  TestNode& device() { return device_; }
  void run(double seconds) { session_.run(seconds); }
  std::shared_ptr<void> listenToForce() { return kind_.listen_to_force(device_, kind_.force); }
  std::string notSubscribed() const {
    return std::string("/device does not subscribe to the hand's force, /") + kind_.force;
  }

  void expectFollowed() {
    session_.run(0.06);  // it looks each 50 ms
    ASSERT_NE(followed().newest(), nullptr);
    EXPECT_FALSE(followed().newest()->header.stamp.isZero()) << session_.diagnostics().text(status_);
  }
  /// And so it stays.
  void expectHeld(const std::string& reason) {
    session_.run(0.06);
    followed().clear();
    session_.run(0.3);
    EXPECT_GT(followed().count(), 10U);
    for (const auto& message : followed().all()) EXPECT_TRUE(message->header.stamp.isZero());
    const auto* status = session_.diagnostics().of(status_);
    ASSERT_NE(status, nullptr);
    EXPECT_EQ(status->level, 1);
    EXPECT_NE(status->message.find(reason), std::string::npos) << status->message;
  }

 private:
  bool isExternal() const { return std::string(kind_.kind) == "external"; }
  void addRig() {
    TestNode& world = session_.world();
    world.repeat("needle/measured_cp", poseMessage(0, 0, 0));
    world.repeat("cell/predicted_cf", wrenchMessage(0, 0, 0));
    world.repeat("controller/injection_state", cell_microinjection::InjectionStatus());
  }
  /// What the hand leads: the needle, or with an adapter the bridge.
  Probe<PoseStamped>& followed() {
    return session_.world().hear<PoseStamped>(isExternal() ? "teleop/servo_cp" : "haptic/measured_cp");
  }

  ReceivingDevice kind_;
  VirtualSession session_;
  TestNode& device_;
  std::string status_;
  std::shared_ptr<void> other_;
};

const ReceivingDevice kDvrkArm =
    receivingDevice<PoseStamped, WrenchStamped>("dvrk", "MTMR/measured_cp", "MTMR/body/servo_cf");

class ForceReceiverTest : public testing::TestWithParam<ReceivingDevice> {};

TEST_P(ForceReceiverTest, TheHandIsFollowedOnlyWhileItsNodeTakesTheForce) {
  FollowedDevice device(GetParam());
  const std::string reason = device.notSubscribed();
  device.expectHeld(reason);
  auto force = device.listenToForce();
  device.expectFollowed();
  force.reset();
  device.expectHeld(reason);
  force = device.listenToForce();
  device.expectFollowed();
}

INSTANTIATE_TEST_SUITE_P(
    Devices, ForceReceiverTest,
    testing::Values(receivingDevice<PoseStamped, WrenchStamped>("external", "haptic/measured_cp", "haptic/servo_cf"),
                    receivingDevice<OmniState, OmniFeedback>("omni", "phantom/state", "phantom/force_feedback"),
                    receivingDevice<PoseStamped, DeviceFeedback>("geomagic", "Geomagic/pose",
                                                                 "Geomagic/force_feedback"),
                    receivingDevice<PoseStamped, WrenchStamped>("force_dimension", "Falcon00/measured_cp",
                                                                "Falcon00/body/servo_cf")),
    [](const auto& device) { return device.param.kind; });

/// An arm of dVRK needs its settings before any force and before the hand counts.
TEST(ForceReceiverOfAnArm, TheHandIsFollowedOnceItsNodeHasTheSettingsAndTakesTheForce) {
  FollowedDevice arm(kDvrkArm);
  cell_microinjection::OperatingState state;
  state.state = "ENABLED";
  state.is_homed = true;
  arm.device().repeat("MTMR/operating_state", state);
  auto force = listen<WrenchStamped>(arm.device(), kDvrkArm.force);
  arm.expectHeld("/device has not received its settings /MTMR/body/set_cf_orientation_absolute");
  const auto absolute = listen<std_msgs::Bool>(arm.device(), "MTMR/body/set_cf_orientation_absolute");
  arm.expectHeld("/device has not received its settings /MTMR/use_gravity_compensation");
  EXPECT_EQ(force->count(), 0U);
  const auto compensated = listen<std_msgs::Bool>(arm.device(), "MTMR/use_gravity_compensation");
  arm.run(0.2);  // from the connection until the settings have arrived
  arm.expectFollowed();
  EXPECT_GT(force->count(), 0U);
  for (const auto& setting : {absolute, compensated}) {
    ASSERT_NE(setting->newest(), nullptr);
    EXPECT_TRUE(setting->newest()->data);
  }
  force.reset();
  arm.expectHeld(arm.notSubscribed());
  force = listen<WrenchStamped>(arm.device(), kDvrkArm.force);
  arm.expectFollowed();
}

}  // namespace
}  // namespace microinjection
