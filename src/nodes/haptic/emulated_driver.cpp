#include "nodes/haptic/emulated_driver.h"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/Joy.h>

#include <optional>

#include "nodes/conversions.h"
#include "nodes/haptic/geomagic_messages.h"
#include "nodes/haptic/omni_messages.h"

namespace microinjection {
namespace {

constexpr double kMillimetre = 1e-3;  // m, of both Touch drivers
constexpr char kFrame[] = "haptic";

Eigen::Vector3d toVector(const geometry_msgs::Vector3& v) { return {v.x, v.y, v.z}; }

template <typename Message, typename Force>
ros::Subscriber listen(ros::NodeHandle& node, const std::string& topic, const EmulatedDriver::Listener& listener,
                       const Force& force) {
  using Event = ros::MessageEvent<const Message>;
  const auto hear = [listener, force](const Event& event) {
    listener(force(*event.getConstMessage()), event.getReceiptTime());
  };
  return node.subscribe<Message, const Event&>(topic, 100, hear, {}, ros::TransportHints().tcpNoDelay());
}

/// `second`: the button that says that the operator is there, which this hand always holds down.
sensor_msgs::Joy toJoy(bool pressed, const ros::Time& now, bool second = false) {
  sensor_msgs::Joy joy;
  joy.header.stamp = now;
  joy.buttons = {pressed ? 1 : 0, second ? 1 : 0};
  return joy;
}

/// Buttons that a driver tells on change only are told again: who was started later must know them.
constexpr int kRepetition = 50;  // samples

class EmulatedCrtk : public EmulatedDriver {
 public:
  EmulatedCrtk(ros::NodeHandle& node, const Listener& listener)
      : position_(node.advertise<geometry_msgs::PoseStamped>("haptic/measured_cp", 10)),
        clutch_(node.advertise<sensor_msgs::Joy>("haptic/clutch", 10, true)),
        present_(node.advertise<sensor_msgs::Joy>("haptic/operator_present", 10)),
        force_(listen<geometry_msgs::WrenchStamped>(
            node, "haptic/servo_cf", listener,
            [](const geometry_msgs::WrenchStamped& message) { return toVector(message.wrench.force); })) {}

  void tell(const Eigen::Vector3d& position, bool clutch, const ros::Time& now) override {
    position_.publish(toPose(position, now, kFrame));
    if (samples_++ % kRepetition == 0) present_.publish(toJoy(true, now));
    if (clutch != told_) clutch_.publish(toJoy(clutch, now));
    told_ = clutch;
  }

 private:
  ros::Publisher position_, clutch_, present_;
  ros::Subscriber force_;
  std::optional<bool> told_;
  int samples_ = 0;
};

class EmulatedOmni : public EmulatedDriver {
 public:
  EmulatedOmni(ros::NodeHandle& node, const Listener& listener)
      : state_(node.advertise<OmniState>("phantom/state", 10)),
        button_(node.advertise<OmniButtonEvent>("phantom/button", 10, true)),
        force_(listen<OmniFeedback>(node, "phantom/force_feedback", listener,
                                    [](const OmniFeedback& message) { return toVector(message.force); })) {}

  void tell(const Eigen::Vector3d& position, bool clutch, const ros::Time& now) override {
    OmniState state;
    state.header.stamp = now;
    state.pose = toPose(Eigen::Vector3d(position / kMillimetre), now, kFrame).pose;
    state_.publish(state);
    if (clutch == told_ && samples_++ % kRepetition != 0) return;
    OmniButtonEvent event;
    event.white_button = 1;
    event.grey_button = clutch ? 1 : 0;
    button_.publish(event);
    told_ = clutch;
  }

 private:
  ros::Publisher state_, button_;
  ros::Subscriber force_;
  std::optional<bool> told_;
  int samples_ = 0;
};

/// With OpenHaptics' axes: x right, y up, z to the operator.
class EmulatedGeomagic : public EmulatedDriver {
 public:
  EmulatedGeomagic(ros::NodeHandle& node, const Listener& listener)
      : pose_(node.advertise<geometry_msgs::PoseStamped>("Geomagic/pose", 10)),
        joy_(node.advertise<sensor_msgs::Joy>("Geomagic/joy", 10)),
        force_(listen<DeviceFeedback>(node, "Geomagic/force_feedback", listener, [](const DeviceFeedback& message) {
          const Eigen::Vector3d force = toVector(message.force);
          return Eigen::Vector3d(force.x(), -force.z(), force.y());
        })) {}

  void tell(const Eigen::Vector3d& position, bool clutch, const ros::Time& now) override {
    const Eigen::Vector3d turned(position.x(), position.z(), -position.y());
    pose_.publish(toPose(Eigen::Vector3d(turned / kMillimetre), now, kFrame));
    joy_.publish(toJoy(clutch, now, true));
  }

 private:
  ros::Publisher pose_, joy_;
  ros::Subscriber force_;
};

}  // namespace

std::vector<std::string> emulatedDrivers() { return {"crtk", "omni", "geomagic"}; }

std::unique_ptr<EmulatedDriver> makeEmulatedDriver(const std::string& kind, ros::NodeHandle& node,
                                                   const EmulatedDriver::Listener& listener) {
  if (kind == "omni") return std::make_unique<EmulatedOmni>(node, listener);
  if (kind == "geomagic") return std::make_unique<EmulatedGeomagic>(node, listener);
  return std::make_unique<EmulatedCrtk>(node, listener);
}

}  // namespace microinjection
