#pragma once

#include <sensor_msgs/Joy.h>

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "nodes/runtime/cycle.h"

namespace microinjection {

/// State of a hand at a device, in the view's axes: x right, y away, z up.
struct EmulatedHand {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m; 10 mm is the end of a stick's axis
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
  bool clutch = false;                                 ///< pressed
  bool present = false;                                ///< holds the dead-man switch down
  bool inject = false;                                 ///< presses the inject button, if any
};

/// Emulates a haptic device and its driver's topics, after the driver's source: messages, units,
/// axes, rates, buttons and rendering of the force.
class EmulatedDriver {
 public:
  /// Receives a force (N, with the message's magnitude) and its time of arrival.
  using Handler = std::function<void(const Eigen::Vector3d& force, const ros::Time& received)>;

  virtual ~EmulatedDriver() = default;
  /// Before each step: receives messages outside of the cycle's inputs.
  virtual void process(const EmulatedHand&) {}
  /// The present force (N) on the hand, in the view's axes. Drivers hold the last force for ever.
  virtual Eigen::Vector3d render(const EmulatedHand&) { return Eigen::Vector3d::Zero(); }
  /// Publishes the driver's messages that are due now.
  virtual void publish(const EmulatedHand& hand, const ros::Time& now) = 0;
};

/// @pre kind is one of emulatedDrivers()
std::unique_ptr<EmulatedDriver> makeEmulatedDriver(const std::string& kind, Cycle& cycle,
                                                   const EmulatedDriver::Handler& handler);
/// crtk: any device that needs no adapter; omni: phantom_omni; geomagic: ros_geomagic;
/// force_dimension: sawForceDimensionSDK; dvrk: a master arm of dVRK 2.1, dvrk_2_0: of 2.0, with
/// transforms; falcon: the driver on libnifalcon of 2025; joy: joy_node with a gamepad; spacenav:
/// spacenav_node.
std::vector<std::string> emulatedDrivers();

// One for each file of emulated drivers.
std::unique_ptr<EmulatedDriver> makeEmulatedCrtk(const std::string& kind, Cycle& cycle,
                                                 const EmulatedDriver::Handler& handler);
std::unique_ptr<EmulatedDriver> makeEmulatedTouch(const std::string& kind, Cycle& cycle,
                                                  const EmulatedDriver::Handler& handler);
std::unique_ptr<EmulatedDriver> makeEmulatedStick(const std::string& kind, Cycle& cycle);

/// Limits the publishing of a driver to its own rate.
class EmulatedRate {
 public:
  explicit EmulatedRate(double period) : period_(period) {}  ///< s
  bool due(const ros::Time& now);

 private:
  double period_;
  ros::Time next_;
};

/// A message with the states of two buttons.
sensor_msgs::Joy toJoy(const ros::Time& now, bool first, bool second = false);

/// Receives a force message without a header.
template <typename Message>
class UnstampedForce {
 public:
  using Handler = std::function<void(const Message& message, const ros::Time& received)>;

  UnstampedForce(Cycle& cycle, const std::string& topic, const Handler& handler)
      : handler_(handler),
        subscription_(cycle.bus().subscribe<Message>(topic, 100, [this](const Delivery<Message>& delivery) {
          waiting_.emplace_back(delivery.message, delivery.raw.received);
        })) {}

  void process() {
    for (const auto& [message, received] : waiting_) handler_(*message, received);
    waiting_.clear();
  }

 private:
  Handler handler_;
  std::vector<std::pair<boost::shared_ptr<const Message>, ros::Time>> waiting_;  ///< and when they arrived
  Subscription subscription_;
};

}  // namespace microinjection
