#include "nodes/haptic/geomagic_adapter.h"

#include "nodes/conversions.h"
#include "nodes/haptic/geomagic_messages.h"

namespace microinjection {

GeomagicConfig GeomagicConfig::read(ConfigReader& reader) {
  GeomagicConfig config;
  reader.text("device", config.device);
  reader.number("length_unit", config.length_unit, Range::positive());
  reader.number("timeout", config.timeout, Range::positive());
  reader.integer("clutch_button", config.clutch_button, Range::closed(-1, 1));
  return config;
}

GeomagicAdapter::GeomagicAdapter(Cycle& cycle, const GeomagicConfig& config)
    : config_(config),
      pose_(cycle.input<geometry_msgs::PoseStamped>(config.device + "/pose", Phase::kSameTick, config.timeout)),
      buttons_(cycle.input<sensor_msgs::Joy>(config.device + "/joy", Phase::kTickBefore, config.timeout)),
      force_(cycle.node().advertise<DeviceFeedback>(config.device + "/force_feedback", 10)) {}

std::optional<HandReading> GeomagicAdapter::read(const Cycle::Tick& tick) {
  const auto* pose = pose_.get(tick.now);
  if (!pose) return std::nullopt;
  const auto position = trustedPosition(pose, pose->header.frame_id);
  if (!position) return std::nullopt;
  HandReading reading;
  reading.position = config_.length_unit * *position;
  reading.stamp = pose->header.stamp;
  if (config_.clutch_button < 0) return reading;
  // Buttons that cannot be read count as pressed.
  const sensor_msgs::Joy* joy = buttons_.get(tick.now);
  const auto index = static_cast<std::size_t>(config_.clutch_button);
  reading.clutch = !joy || index >= joy->buttons.size() || joy->buttons[index] != 0;
  return reading;
}

void GeomagicAdapter::render(const Eigen::Vector3d& force, const Cycle::Tick&) {
  DeviceFeedback feedback;
  feedback.force.x = force.x();
  feedback.force.y = force.y();
  feedback.force.z = force.z();
  force_.publish(feedback);
}

}  // namespace microinjection
