#include "nodes/haptic/geomagic_adapter.h"

#include "nodes/runtime/conversions.h"

namespace microinjection {
namespace {

/// Whether a button is pressed. Returns `none` without such a button, `unknown` without a valid
/// message.
bool pressed(const sensor_msgs::Joy* joy, int button, bool none, bool unknown) {
  if (button < 0) return none;
  const auto index = static_cast<std::size_t>(button);
  return joy && index < joy->buttons.size() ? joy->buttons[index] != 0 : unknown;
}

}  // namespace

GeomagicConfig GeomagicConfig::read(ConfigReader& reader) {
  GeomagicConfig config;
  reader.text("device", config.device);
  reader.number("length_unit", config.length_unit, Range::positive());
  reader.number("timeout", config.timeout, Range::positive());
  reader.integer("clutch_button", config.clutch_button, Range::closed(-1, 1));
  reader.integer("operator_button", config.operator_button, Range::closed(-1, 1));
  if (config.operator_button >= 0 && config.operator_button == config.clutch_button) {
    reader.error("operator_button", "must be another than clutch_button");
  }
  return config;
}

GeomagicAdapter::GeomagicAdapter(Cycle& cycle, const GeomagicConfig& config)
    : config_(config),
      pose_(cycle.input<geometry_msgs::PoseStamped>(config.device + "/pose", InputPhase::kDrives, config.timeout)),
      buttons_(cycle.input<sensor_msgs::Joy>(config.device + "/joy", InputPhase::kSampled, config.timeout)),
      force_(cycle.bus().advertise<DeviceFeedback>(config.device + "/force_feedback", 10)),
      receiver_(cycle, force_) {
  receiver_.monitor(pose_);
}

std::optional<HandReading> GeomagicAdapter::read(const Cycle::Tick& tick) {
  const auto* pose = pose_.get(tick.now);
  if (!pose || !receiver_.isConnected()) return std::nullopt;
  const auto position = validPosition(pose, pose->header.frame_id, kLargestHandDistance / config_.length_unit);
  if (!position) return std::nullopt;
  HandReading reading;
  reading.position = config_.length_unit * *position;
  reading.stamp = pose->header.stamp;
  // Without a valid message the clutch counts as pressed and the dead-man switch as released.
  const sensor_msgs::Joy* joy = buttons_.get(tick.now);
  reading.clutch = pressed(joy, config_.clutch_button, false, true);
  reading.operator_present = pressed(joy, config_.operator_button, true, false);
  return reading;
}

void GeomagicAdapter::render(const Eigen::Vector3d& force, const Cycle::Tick&) {
  DeviceFeedback feedback;
  feedback.force = toMessage<geometry_msgs::Vector3>(force);
  force_.publish(feedback);
}

}  // namespace microinjection
