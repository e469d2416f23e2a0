// The Touch's two drivers. Both hold the last force for ever, less a damping by the velocity at its
// arrival.

#include <geometry_msgs/PoseStamped.h>

#include <cmath>

#include "benchmark/emulated_haptic/emulated_driver.h"
#include "nodes/haptic/geomagic_messages.h"
#include "nodes/haptic/omni_messages.h"
#include "nodes/runtime/conversions.h"

namespace microinjection {
namespace {

constexpr double kMillimetre = 1e-3;     // m, of both drivers
constexpr double kDriverDamping = 1e-3;  // N s/mm, of both drivers

Eigen::Vector3d damping(const EmulatedHand& hand) { return kDriverDamping * hand.velocity / kMillimetre; }

/// phantom_omni's omni_state: state, button, force_feedback at 1 kHz, in the axes (X, -Z, Y) of
/// OpenHaptics, which are the view's. Buttons are published on change and not latched. Each press
/// of the white one toggles `locked`, each of the grey one `close_gripper`; neither has an effect.
class EmulatedOmni : public EmulatedDriver {
 public:
  EmulatedOmni(Cycle& cycle, const Handler& handler)
      : state_(cycle.output<OmniState>("phantom/state")),
        button_(cycle.bus().advertise<OmniButtonEvent>("phantom/button", 100)),
        messages_(cycle, "phantom/force_feedback", [this, handler](const OmniFeedback& message, const auto& received) {
          force_ = toVector(message.force) - damping_;
          handler(toVector(message.force), received);
        }) {}

  void process(const EmulatedHand& hand) override {
    damping_ = damping(hand);
    messages_.process();
  }
  Eigen::Vector3d render(const EmulatedHand&) override { return force_; }

  void publish(const EmulatedHand& hand, const ros::Time& now) override {
    last_published_.header.stamp = now;
    last_published_.pose = toPose(Eigen::Vector3d(hand.position / kMillimetre), now, "").pose;
    last_published_.velocity = toMessage<geometry_msgs::Vector3>(hand.velocity / kMillimetre);
    state_.publish(last_published_);
    OmniButtonEvent event;
    event.grey_button = hand.clutch ? 1 : 0;
    event.white_button = hand.present ? 1 : 0;
    if (event.grey_button == buttons_.grey_button && event.white_button == buttons_.white_button) return;
    if (event.grey_button == 1) last_published_.close_gripper = !last_published_.close_gripper;
    if (event.white_button == 1) last_published_.locked = !last_published_.locked;
    buttons_ = event;
    button_.publish(event);
  }

 private:
  Output<OmniState>& state_;
  Publisher<OmniButtonEvent> button_;
  UnstampedForce<OmniFeedback> messages_;
  OmniState last_published_;
  OmniButtonEvent buttons_;
  Eigen::Vector3d damping_ = Eigen::Vector3d::Zero();  // N
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();    // N
};

/// ros_geomagic's geomagic_control: pose, joy, force_feedback at 100 Hz (its /publish_rate), in the
/// axes of OpenHaptics: x right, y up, z to the operator. A pose more than 5 mm from the last one
/// counts as a glitch: the last one is published again.
class EmulatedGeomagic : public EmulatedDriver {
 public:
  EmulatedGeomagic(Cycle& cycle, const Handler& handler)
      : bus_(cycle.bus()),
        pose_(cycle.output<geometry_msgs::PoseStamped>("Geomagic/pose")),
        joy_(cycle.output<sensor_msgs::Joy>("Geomagic/joy")),
        messages_(cycle, "Geomagic/force_feedback",
                  [this, handler](const DeviceFeedback& message, const auto& received) {
                    receive(message);
                    handler(toVector(message.force), received);
                  }),
        rate_(1 / bus_.parameter("/publish_rate").as<double>(100)) {}

  void process(const EmulatedHand& hand) override {
    position_ = toDevice(hand.position) / kMillimetre;
    damping_ = toDevice(damping(hand));
    messages_.process();
  }

  Eigen::Vector3d render(const EmulatedHand&) override {
    Eigen::Vector3d force = force_;
    for (int i = 0; i < 3; ++i) {
      if (lock_[i] != 0) force[i] = kLockStiffness * (lock_position_[i] - position_[i]) - damping_[i];
    }
    return {force.x(), -force.z(), force.y()};
  }

  void publish(const EmulatedHand& hand, const ros::Time& now) override {
    if (!rate_.due(now)) return;
    const Eigen::Vector3d position = toDevice(hand.position) / kMillimetre;
    const bool glitch = last_published_ && (position - *last_published_).cwiseAbs().maxCoeff() > kGlitch;
    if (!glitch) last_published_ = position;
    pose_.publish(toPose(*last_published_, now, "world"));
    sensor_msgs::Joy joy = toJoy(now, hand.clutch, hand.present);
    for (int i = 0; i < 3; ++i) joy.axes.push_back(static_cast<float>(position[i]));
    joy.axes.resize(6);
    joy_.publish(joy);
  }

 private:
  static constexpr double kGlitch = 5;           // mm
  static constexpr double kLockStiffness = 0.3;  // N/mm

  static Eigen::Vector3d toDevice(const Eigen::Vector3d& v) { return {v.x(), v.z(), -v.y()}; }

  void receive(const DeviceFeedback& message) {
    if (message.lock.size() < 3) {
      ROS_FATAL("the driver would read past the end of `lock`");
      return bus_.stop();
    }
    force_ = toVector(message.force) - damping_;
    lock_position_ = toVector(message.position);
    lock_ = message.lock;
  }

  Bus& bus_;
  Output<geometry_msgs::PoseStamped>& pose_;
  Output<sensor_msgs::Joy>& joy_;
  UnstampedForce<DeviceFeedback> messages_;
  EmulatedRate rate_;
  std::optional<Eigen::Vector3d> last_published_;            // mm
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();       // mm
  Eigen::Vector3d damping_ = Eigen::Vector3d::Zero();        // N
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();          // N
  Eigen::Vector3d lock_position_ = Eigen::Vector3d::Zero();  // mm
  std::vector<std::uint8_t> lock_ = {0, 0, 0};
};

}  // namespace

std::unique_ptr<EmulatedDriver> makeEmulatedTouch(const std::string& kind, Cycle& cycle,
                                                  const EmulatedDriver::Handler& handler) {
  if (kind == "omni") return std::make_unique<EmulatedOmni>(cycle, handler);
  return std::make_unique<EmulatedGeomagic>(cycle, handler);
}

}  // namespace microinjection
