// Devices whose drivers use CRTK topics, with their differences.

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <std_msgs/Bool.h>

#include <limits>

#include "benchmark/emulated_haptic/emulated_driver.h"
#include "cell_microinjection/OperatingState.h"
#include "nodes/runtime/conversions.h"

namespace microinjection {
namespace {

constexpr double kForEver = std::numeric_limits<double>::infinity();
using geometry_msgs::WrenchStamped;

/// A device that needs no adapter: /haptic/measured_cp, clutch, operator_present and servo_cf, in
/// the view's axes.
class EmulatedCrtk : public EmulatedDriver {
 public:
  EmulatedCrtk(Cycle& cycle, const Handler& handler)
      : position_(cycle.output<geometry_msgs::PoseStamped>("haptic/measured_cp")),
        clutch_(cycle.output<sensor_msgs::Joy>("haptic/clutch", true)),
        present_(cycle.output<sensor_msgs::Joy>("haptic/operator_present", true)) {
    cycle.input<WrenchStamped>("haptic/servo_cf", InputPhase::kSampled, kForEver)
        .onMessage([this, handler](const WrenchStamped& message, const ros::Time& received) {
          force_ = toVector(message.wrench.force);
          handler(force_, received);
        });
  }

  Eigen::Vector3d render(const EmulatedHand&) override { return force_; }

  void publish(const EmulatedHand& hand, const ros::Time& now) override {
    position_.publish(toPose(hand.position, now, "haptic"));
    if (hand.clutch != last_published_.clutch) clutch_.publish(toJoy(now, hand.clutch));
    if (hand.present != last_published_.present) present_.publish(toJoy(now, hand.present));
    last_published_ = hand;
  }

 private:
  Output<geometry_msgs::PoseStamped>& position_;
  Output<sensor_msgs::Joy>&clutch_, &present_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();  // N
  EmulatedHand last_published_;
};

struct CisstDevice {
  std::string device;
  std::string frame;
  Eigen::Matrix3d axes;  ///< device = axes * view
  double period;         ///< s
  bool transform;        ///< positions are TransformStamped
  std::string clutch, present;
  bool is_arm;  ///< of dVRK; else behind sawForceDimensionSDK
};

/// A device behind the cisst-ros bridge of sawForceDimensionSDK or dVRK. It holds its position
/// until the first force on body/servo_cf, whatever the message's frame and stamp. An arm of dVRK
/// expects forces in the gripper's frame unless body/set_cf_orientation_absolute, weighs on the
/// hand unless use_gravity_compensation, and publishes its state. The Force Dimension SDK expects
/// forces in the axes of the base and compensates the weight. Buttons are published on change,
/// latched.
class EmulatedCisst : public EmulatedDriver {
 public:
  EmulatedCisst(Cycle& cycle, const CisstDevice& device, const Handler& handler)
      : device_(device),
        clutch_(cycle.output<sensor_msgs::Joy>(device.clutch, true)),
        present_(cycle.output<sensor_msgs::Joy>(device.present, true)),
        rate_(device.period) {
    const std::string position = device.device + "/measured_cp";
    if (device.transform) {
      transform_ = &cycle.output<geometry_msgs::TransformStamped>(position);
    } else {
      pose_ = &cycle.output<geometry_msgs::PoseStamped>(position);
    }
    cycle.input<WrenchStamped>(device.device + "/body/servo_cf", InputPhase::kSampled, kForEver)
        .onMessage([this, handler](const WrenchStamped& message, const ros::Time& received) {
          force_ = toVector(message.wrench.force);
          freed_ = true;
          handler(force_, received);
        });
    if (!device.is_arm) return;
    subscribe(cycle, "/body/set_cf_orientation_absolute", absolute_);
    subscribe(cycle, "/use_gravity_compensation", compensated_);
    state_ = &cycle.output<cell_microinjection::OperatingState>(device.device + "/operating_state", true);
  }

  Eigen::Vector3d render(const EmulatedHand& hand) override {
    if (!freed_) {
      if (!held_) held_ = hand.position;
      return kHold * (*held_ - hand.position);
    }
    const Eigen::Vector3d force_on_hand = absolute_ || !device_.is_arm ? force_ : Eigen::Vector3d(gripper() * force_);
    const double weight = device_.is_arm && !compensated_ ? kWeight : 0;
    return device_.axes.transpose() * force_on_hand - weight * Eigen::Vector3d::UnitZ();
  }

  void publish(const EmulatedHand& hand, const ros::Time& now) override {
    if (state_ && !state_published_) publishState(now);
    if (hand.clutch != last_published_.clutch) clutch_.publish(toButton(now, hand.clutch));
    if (hand.present != last_published_.present) present_.publish(toButton(now, hand.present));
    last_published_ = hand;
    if (!rate_.due(now)) return;
    const geometry_msgs::PoseStamped pose = toPose(Eigen::Vector3d(device_.axes * hand.position), now, device_.frame);
    if (pose_) return pose_->publish(pose);
    geometry_msgs::TransformStamped transform;
    transform.header = pose.header;
    transform.transform.translation = toMessage<geometry_msgs::Vector3>(toVector(pose.pose.position));
    transform.transform.rotation.w = 1;
    transform_->publish(transform);
  }

 private:
  static constexpr double kHold = 2000;  // N/m, of the position control
  static constexpr double kWeight = 5;   // N, of an arm

  /// A gripper that points to the left of the arm's base: its x is the base's z.
  static Eigen::Matrix3d gripper() { return (Eigen::Matrix3d() << 0, 0, 1, 1, 0, 0, 0, 1, 0).finished(); }

  static sensor_msgs::Joy toButton(const ros::Time& now, bool pressed) {
    sensor_msgs::Joy joy = toJoy(now, pressed);
    joy.buttons.resize(1);
    return joy;
  }

  /// Publishes the state of an arm that was homed at the console, on change only.
  void publishState(const ros::Time& now) {
    cell_microinjection::OperatingState state;
    state.header.stamp = now;
    state.state = "ENABLED";
    state.is_homed = true;
    state_->publish(state);
    state_published_ = true;
  }

  void subscribe(Cycle& cycle, const std::string& topic, bool& value) {
    subscriptions_.push_back(cycle.bus().subscribe<std_msgs::Bool>(
        device_.device + topic, 1,
        [&value](const Delivery<std_msgs::Bool>& delivery) { value = delivery.message->data; }));
  }

  CisstDevice device_;
  Output<geometry_msgs::PoseStamped>* pose_ = nullptr;
  Output<geometry_msgs::TransformStamped>* transform_ = nullptr;
  Output<cell_microinjection::OperatingState>* state_ = nullptr;  // null: not published
  Output<sensor_msgs::Joy>&clutch_, &present_;
  std::vector<Subscription> subscriptions_;
  EmulatedRate rate_;
  std::optional<Eigen::Vector3d> held_;              // m, the view's axes
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();  // N, as received
  bool state_published_ = false, freed_ = false, absolute_ = false, compensated_ = false;
  EmulatedHand last_published_;
};

/// The driver on libnifalcon: /falcon/measured_cp and joy at 1 kHz, latched, x right, y up, z to
/// the operator from the device's front. It ignores a force in another frame than its own, but
/// accepts one without a frame.
class EmulatedFalcon : public EmulatedDriver {
 public:
  EmulatedFalcon(Cycle& cycle, const Handler& handler)
      : position_(cycle.output<geometry_msgs::PoseStamped>("falcon/measured_cp", true)),
        joy_(cycle.output<sensor_msgs::Joy>("falcon/joy", true)) {
    cycle.input<WrenchStamped>("falcon/servo_cf", InputPhase::kSampled, kForEver)
        .onMessage([this, handler](const WrenchStamped& message, const ros::Time& received) {
          handler(toVector(message.wrench.force), received);
          if (message.header.frame_id.empty() || message.header.frame_id == kFrame)
            force_ = toVector(message.wrench.force);
        });
  }

  Eigen::Vector3d render(const EmulatedHand&) override { return {force_.x(), -force_.z(), force_.y()}; }

  void publish(const EmulatedHand& hand, const ros::Time& now) override {
    const Eigen::Vector3d& p = hand.position;
    const Eigen::Vector3d position(p.x(), p.z(), kCentre - p.y());
    position_.publish(toPose(position, now, kFrame));
    sensor_msgs::Joy joy = toJoy(now, hand.present, hand.clutch);
    joy.header.frame_id = kFrame;
    for (int i = 0; i < 3; ++i) joy.axes.push_back(static_cast<float>(position[i]));
    joy.buttons.resize(4);
    joy_.publish(joy);
  }

 private:
  static constexpr char kFrame[] = "falcon_front";
  static constexpr double kCentre = 0.12;  // m, of the workspace from the device's front

  Output<geometry_msgs::PoseStamped>& position_;
  Output<sensor_msgs::Joy>& joy_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();  // N, as received
};

CisstDevice forceDimension() {
  // The SDK's axes: x to the operator, y right, z up.
  return {"Falcon00",
          "Falcon00_base",
          (Eigen::Matrix3d() << 0, -1, 0, 1, 0, 0, 0, 0, 1).finished(),
          0.01,
          false,
          "Falcon00/top",
          "Falcon00/center",
          false};
}

CisstDevice dvrk(bool transform) {
  // The stereo viewer's axes: x left, y up, z into the picture.
  return {"MTMR",
          "HRSV",
          (Eigen::Matrix3d() << -1, 0, 0, 0, 0, 1, 0, 1, 0).finished(),
          0.01,
          transform,
          "console/clutch",
          "console/operator_present",
          true};
}

}  // namespace

std::unique_ptr<EmulatedDriver> makeEmulatedCrtk(const std::string& kind, Cycle& cycle,
                                                 const EmulatedDriver::Handler& handler) {
  if (kind == "force_dimension") return std::make_unique<EmulatedCisst>(cycle, forceDimension(), handler);
  if (kind == "dvrk") return std::make_unique<EmulatedCisst>(cycle, dvrk(false), handler);
  if (kind == "dvrk_2_0") return std::make_unique<EmulatedCisst>(cycle, dvrk(true), handler);
  if (kind == "falcon") return std::make_unique<EmulatedFalcon>(cycle, handler);
  return std::make_unique<EmulatedCrtk>(cycle, handler);
}

}  // namespace microinjection
