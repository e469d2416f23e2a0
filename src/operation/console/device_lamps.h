#pragma once

#include <array>
#include <map>
#include <string>

#include "operation/console/light.h"

namespace microinjection {

/// A status of /diagnostics: of one task of one node.
struct NodeReport {
  std::string name;  ///< "node: task"
  int level = 0;     ///< 0 OK, 1 warning, 2 error, 3 stale
  std::string message;
};

/// The devices of a session.
enum class Device { kRig, kCamera, kSensor, kHand, kCell };
constexpr std::array<Device, 5> kDevices = {Device::kRig, Device::kCamera, Device::kSensor, Device::kHand,
                                            Device::kCell};
const char* toText(Device device);

/// The lamps of the devices, from what their nodes report on /diagnostics.
///
/// A lamp is green while all tasks of the device's nodes report OK. Else it has the colour and the
/// text of the worst: yellow for a warning, red for an error. A device whose nodes were heard and
/// are silent is red. One that was never heard is grey: the session has none.
class DeviceLamps {
 public:
  static constexpr double kSilence = 3.5;  ///< s without a report; nodes report each second

  /// `now`: s, of a clock that does not jump.
  void receive(const NodeReport& report, double now);
  Lamp lamp(Device device, double now) const;

 private:
  struct Heard {
    NodeReport report;
    double at = 0;  ///< s
  };
  std::array<std::map<std::string, Heard>, kDevices.size()> heard_;
};

}  // namespace microinjection
