#include "nodes/haptic/omni_adapter.h"

namespace microinjection {

OmniConfig OmniConfig::read(ConfigReader& reader) {
  OmniConfig config;
  reader.text("device", config.device);
  reader.number("length_unit", config.length_unit, Range::positive());
  reader.number("timeout", config.timeout, Range::positive());
  reader.choice("clutch_button", config.clutch_button, {"grey", "white", "none"});
  return config;
}

OmniAdapter::OmniAdapter(Cycle& cycle, const OmniConfig& config)
    : config_(config),
      state_(cycle.input<OmniState>(config.device + "/state", Phase::kSameTick, config.timeout)),
      force_(cycle.node().advertise<OmniFeedback>(config.device + "/force_feedback", 10)) {
  if (config.clutch_button == "none") return;
  buttons_ = cycle.node().subscribe<OmniButtonEvent>(
      config.device + "/button", 10, [this](const boost::shared_ptr<const OmniButtonEvent>& event) {
        clutch_ = (config_.clutch_button == "grey" ? event->grey_button : event->white_button) != 0;
      });
}

std::optional<HandReading> OmniAdapter::read(const Cycle::Tick& tick) {
  const OmniState* state = state_.get(tick.now);
  if (!state) return std::nullopt;
  const auto& p = state->pose.position;
  HandReading reading;
  reading.position = config_.length_unit * Eigen::Vector3d(p.x, p.y, p.z);
  if (!reading.position.allFinite()) return std::nullopt;
  reading.stamp = state->header.stamp;
  reading.clutch = clutch_ || state->locked;
  return reading;
}

void OmniAdapter::render(const Eigen::Vector3d& force, const Cycle::Tick&) {
  OmniFeedback feedback;
  feedback.force.x = force.x();
  feedback.force.y = force.y();
  feedback.force.z = force.z();
  force_.publish(feedback);
}

}  // namespace microinjection
