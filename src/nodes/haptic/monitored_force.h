#pragma once

#include <ros/time.h>

#include <functional>
#include <memory>
#include <string>

#include "nodes/bus/bus.h"

namespace microinjection {

/// The force topic of a haptic device: reports forces of other nodes and publishes zero force.
class MonitoredForce {
 public:
  using Handler = std::function<void()>;

  /// @param kind    crtk, omni or geomagic
  /// @param device  namespace of the driver's topics; for crtk without an adapter: /haptic, which
  ///                sessions remap
  /// @param force   for crtk: topic of the force, below device
  static std::unique_ptr<MonitoredForce> make(const std::string& kind, const std::string& device,
                                              const std::string& force, Bus& bus, Handler handler);
  virtual ~MonitoredForce() = default;
  virtual void publishZeroForce(const ros::Time& now) = 0;
};

}  // namespace microinjection
