#pragma once

#include <ros/ros.h>

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace microinjection {

/// A haptic device as its own driver shows it: its topics, units and axes. Positions (m) and forces (N) here have the
/// axes of a CRTK device.
class EmulatedDriver {
 public:
  /// A force on the hand, and when its message came.
  using Listener = std::function<void(const Eigen::Vector3d& force, const ros::Time& received)>;

  virtual ~EmulatedDriver() = default;
  /// Where the hand is now.
  virtual void tell(const Eigen::Vector3d& position, bool clutch, const ros::Time& now) = 0;
};

/// crtk (/haptic/measured_cp, clutch, servo_cf), omni (phantom_omni's) or geomagic (ros_geomagic's). Forces are heard
/// where the node handle's messages are. @pre kind is one of emulatedDrivers()
std::unique_ptr<EmulatedDriver> makeEmulatedDriver(const std::string& kind, ros::NodeHandle& node,
                                                   const EmulatedDriver::Listener& listener);
std::vector<std::string> emulatedDrivers();

}  // namespace microinjection
