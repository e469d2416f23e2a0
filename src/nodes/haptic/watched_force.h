#pragma once

#include <ros/ros.h>

#include <functional>
#include <memory>
#include <string>

namespace microinjection {

/// The topic on which a haptic device takes its force: tells when another node has spoken there, and says zero force.
class WatchedForce {
 public:
  using Heard = std::function<void()>;

  /// @param kind    crtk, omni or geomagic
  /// @param device  namespace of the driver's topics; of crtk without an adapter: /haptic, that sessions remap
  /// @param force   of crtk: topic of the force, below device
  static std::unique_ptr<WatchedForce> make(const std::string& kind, const std::string& device,
                                            const std::string& force, ros::NodeHandle node, Heard heard);
  virtual ~WatchedForce() = default;
  virtual void publishZeroForce(const ros::Time& now) = 0;
};

}  // namespace microinjection
