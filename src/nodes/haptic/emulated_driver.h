#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/Joy.h>

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "nodes/runtime/cycle.h"

namespace microinjection {

/// What a hand does with a device, in the view's axes: x right, y away, z up.
struct EmulatedHand {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m; of a stick 10 mm is the end of an axis
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
  bool clutch = false;                                 ///< pressed
  bool present = false;                                ///< holds the dead-man down
  bool inject = false;                                 ///< presses the button for it, on devices that have one
};

/// A haptic device behind its driver's topics, written from the driver's source: its messages, units, axes, rates and
/// buttons, and what it does with the force.
class EmulatedDriver {
 public:
  /// A force (N, of the size that the message has), and when it came.
  using Listener = std::function<void(const Eigen::Vector3d& force, const ros::Time& received)>;

  virtual ~EmulatedDriver() = default;
  /// Before each step: takes what has come outside of the cycle's inputs.
  virtual void process(const EmulatedHand&) {}
  /// N on the hand now, in the view's axes: drivers hold the last force for ever.
  virtual Eigen::Vector3d render(const EmulatedHand&) { return Eigen::Vector3d::Zero(); }
  /// Publishes what the driver would now.
  virtual void publish(const EmulatedHand& hand, const ros::Time& now) = 0;
  /// Its buttons take no part in the lock step: they come when they come.
  virtual bool hasUnstampedButtons() const { return false; }
};

/// @pre kind is one of emulatedDrivers()
std::unique_ptr<EmulatedDriver> makeEmulatedDriver(const std::string& kind, Cycle& cycle,
                                                   const EmulatedDriver::Listener& listener);
/// crtk: any device that needs no adapter; omni: phantom_omni; geomagic: ros_geomagic; force_dimension:
/// sawForceDimensionSDK; dvrk: a master arm of dVRK 2.1, dvrk_2_0: of 2.0, with transforms; falcon: the driver on
/// libnifalcon of 2025; joy: joy_node with a gamepad; spacenav: spacenav_node.
std::vector<std::string> emulatedDrivers();

// Of each file.
std::unique_ptr<EmulatedDriver> makeEmulatedCrtk(const std::string& kind, Cycle& cycle,
                                                 const EmulatedDriver::Listener& listener);
std::unique_ptr<EmulatedDriver> makeEmulatedTouch(const std::string& kind, Cycle& cycle,
                                                  const EmulatedDriver::Listener& listener);
std::unique_ptr<EmulatedDriver> makeEmulatedStick(const std::string& kind, Cycle& cycle);

/// Lets through what a driver publishes at its own rate.
class EmulatedRate {
 public:
  explicit EmulatedRate(double period) : period_(period) {}  ///< s
  bool due(const ros::Time& now);

 private:
  double period_;
  ros::Time next_;
};

/// The first button is `first`, the second `second`.
sensor_msgs::Joy toJoy(const ros::Time& now, bool first, bool second = false);

/// A force that has no header. In lock step each step waits for the one of the tick before, since such a topic takes no
/// part in it. In the first two ticks not all are connected.
template <typename Message>
class UnstampedForce {
 public:
  using Handler = std::function<void(const Message& message, const ros::Time& received)>;

  UnstampedForce(const Cycle& cycle, const std::string& topic, const Handler& handler) : lockstep_(cycle.lockstep()) {
    using Event = ros::MessageEvent<const Message>;
    const auto receive = [this, handler](const Event& event) {
      ++count_;
      handler(*event.getConstMessage(), event.getReceiptTime());
    };
    node_.setCallbackQueue(&queue_);
    subscriber_ = node_.subscribe<Message, const Event&>(topic, 100, receive, {}, ros::TransportHints().tcpNoDelay());
  }

  void process() {
    const unsigned before = count_;
    queue_.callAvailable();
    if (!lockstep_ || ++steps_ <= 2) return;
    while (ros::ok() && count_ == before) queue_.callAvailable(ros::WallDuration(0.1));
  }

 private:
  bool lockstep_;
  unsigned count_ = 0, steps_ = 0;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Subscriber subscriber_;
};

}  // namespace microinjection
