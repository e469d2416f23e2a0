#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/Joy.h>

#include <string>

#include "nodes/haptic/force_receiver.h"
#include "nodes/haptic/geomagic_messages.h"
#include "nodes/haptic/haptic_adapter.h"

namespace microinjection {

struct GeomagicConfig {
  std::string device = "Geomagic";  ///< namespace of the driver's topics
  double length_unit = 1e-3;        ///< m, of the driver's positions
  double timeout = 0.1;             ///< s, past which the device is stale; the driver publishes at 100 Hz
  int clutch_button = 0;            ///< of DEVICE/joy: 0 grey, 1 white; -1: none
  int operator_button = 1;          ///< the same; held down: the operator is present

  static GeomagicConfig read(ConfigReader& reader);
};

/// geomagic_control (ros_geomagic; Touch): DEVICE/pose and DEVICE/joy in, DEVICE/force_feedback
/// out, in the axes of OpenHaptics (x right, y up, z to the operator); the bridge's device_axes
/// rotates them.
class GeomagicAdapter : public HapticAdapter {
 public:
  using Config = GeomagicConfig;
  GeomagicAdapter(Cycle& cycle, const GeomagicConfig& config);

  std::optional<HandReading> read(const Cycle::Tick& tick) override;
  void render(const Eigen::Vector3d& force, const Cycle::Tick& tick) override;
  std::string invalidReason() const override { return receiver_.reason(); }

 private:
  GeomagicConfig config_;
  Input<geometry_msgs::PoseStamped>& pose_;
  Input<sensor_msgs::Joy>& buttons_;
  Publisher<DeviceFeedback> force_;
  ForceReceiver receiver_;
};

}  // namespace microinjection
