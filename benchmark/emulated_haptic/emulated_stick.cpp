// A gamepad behind joy_node and a space mouse behind spacenav_node. Neither renders a force.

#include <cmath>

#include "benchmark/emulated_haptic/emulated_driver.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {
namespace {

constexpr double kEnd = 0.01;  // m of an EmulatedHand at the end of an axis

Eigen::Vector3d share(const EmulatedHand& hand) { return (hand.position / kEnd).cwiseMax(-1).cwiseMin(1); }

/// joy_node with `_autorepeat_rate:=50` and a gamepad of the Xbox kind: axes are positive to the
/// left and up, and 0 within the dead zone of 0.05. It publishes changes at once.
class EmulatedJoy : public EmulatedDriver {
 public:
  explicit EmulatedJoy(Cycle& cycle) : joy_(cycle.output<sensor_msgs::Joy>("joy")) {}

  void publish(const EmulatedHand& hand, const ros::Time& now) override {
    const Eigen::Vector3d at = share(hand);
    sensor_msgs::Joy joy;
    joy.header.stamp = now;
    joy.axes.resize(8);
    joy.axes[0] = axis(-at.x());  // left stick
    joy.axes[1] = axis(at.y());
    joy.axes[4] = axis(at.z());  // right stick
    joy.buttons.resize(11);
    joy.buttons[0] = hand.inject ? 1 : 0;   // A
    joy.buttons[4] = hand.present ? 1 : 0;  // left shoulder
    const bool changed = joy.axes != last_published_.axes || joy.buttons != last_published_.buttons;
    if (!changed && secondsBetween(last_published_.header.stamp, now) < kRepetition) return;
    last_published_ = joy;
    joy_.publish(joy);
  }

 private:
  static constexpr double kDeadZone = 0.05;
  static constexpr double kRepetition = 0.02;  // s

  static float axis(double value) {
    const double past = std::abs(value) - kDeadZone;
    return static_cast<float>(past > 0 ? std::copysign(past / (1 - kDeadZone), value) : 0);
  }

  Output<sensor_msgs::Joy>& joy_;
  sensor_msgs::Joy last_published_;
};

/// spacenav_node: x away, y left, z up. It publishes a deflected cap with each of the device's
/// reports, every 16 ms. After 30 polls of a millisecond without a report it publishes zeros
/// repeatedly. Buttons are published at once.
class EmulatedSpacenav : public EmulatedDriver {
 public:
  explicit EmulatedSpacenav(Cycle& cycle) : joy_(cycle.output<sensor_msgs::Joy>("spacenav/joy")) {}

  void publish(const EmulatedHand& hand, const ros::Time& now) override {
    const Eigen::Vector3d at = share(hand);
    if (hand.inject != inject_) {
      inject_ = hand.inject;
      return publish(at_, now);
    }
    if (at.isZero(0)) {
      if (quiet_.due(now)) publish(at, now);
    } else if (report_.due(now)) {
      publish(at, now);
    }
  }

 private:
  void publish(const Eigen::Vector3d& at, const ros::Time& now) {
    at_ = at;
    sensor_msgs::Joy joy = toJoy(now, inject_);
    joy.axes = {static_cast<float>(at.y()), static_cast<float>(-at.x()), static_cast<float>(at.z()), 0, 0, 0};
    joy_.publish(joy);
  }

  Output<sensor_msgs::Joy>& joy_;
  EmulatedRate report_{0.016}, quiet_{0.031};
  Eigen::Vector3d at_ = Eigen::Vector3d::Zero();
  bool inject_ = false;
};

}  // namespace

std::unique_ptr<EmulatedDriver> makeEmulatedStick(const std::string& kind, Cycle& cycle) {
  if (kind == "joy") return std::make_unique<EmulatedJoy>(cycle);
  return std::make_unique<EmulatedSpacenav>(cycle);
}

}  // namespace microinjection
