#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <ros/ros.h>

#include <string>

namespace microinjection {

/// Says zero force, again and again, on the topic of a haptic device that speaks CRTK while nobody else says any: such
/// a driver may hold the last force for ever, and the bridge may have been killed. Devices with an adapter of ours need
/// none (haptic_device_node.h).
///
/// In and out: /haptic/servo_cf (WrenchStamped, N)
///
/// Parameters (private):
///   timeout  s without a force of another node's; default 0.05, in (0, inf)
///   rate     Hz, of looking and of zero force; default 200, in [50, 5000]
class ForceWatchdogNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  ForceWatchdogNode(ros::NodeHandle node, const ros::NodeHandle& private_node);
  void run();

 private:
  struct Parameters {
    double timeout = 0.05;  // s
    double rate = 200;      // Hz
    static Parameters read(const ros::NodeHandle& private_node);
  };
  using Event = ros::MessageEvent<const geometry_msgs::WrenchStamped>;

  void hear(const Event& event);

  Parameters parameters_;
  ros::Publisher force_;
  ros::Subscriber subscriber_;
  ros::Time heard_;    ///< when another node's force came last
  std::string frame_;  ///< of that force
};

}  // namespace microinjection
