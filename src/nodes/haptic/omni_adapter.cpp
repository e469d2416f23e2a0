#include "nodes/haptic/omni_adapter.h"

#include "nodes/runtime/conversions.h"

namespace microinjection {
namespace {

bool pressed(const OmniButtonEvent& event, const std::string& button) {
  return (button == "grey" && event.grey_button != 0) || (button == "white" && event.white_button != 0);
}

}  // namespace

OmniConfig OmniConfig::read(ConfigReader& reader) {
  OmniConfig config;
  reader.text("device", config.device);
  reader.number("length_unit", config.length_unit, Range::positive());
  reader.number("timeout", config.timeout, Range::positive());
  reader.choice("clutch_button", config.clutch_button, {"grey", "white", "none"});
  reader.choice("operator_button", config.operator_button, {"grey", "white", "none"});
  if (config.operator_button != "none" && config.operator_button == config.clutch_button) {
    reader.error("operator_button", "must be another than clutch_button");
  }
  return config;
}

OmniAdapter::OmniAdapter(Cycle& cycle, const OmniConfig& config)
    : config_(config),
      state_(cycle.input<OmniState>(config.device + "/state", InputPhase::kDrives, config.timeout)),
      force_(cycle.bus().advertise<OmniFeedback>(config.device + "/force_feedback", 10)),
      receiver_(cycle, force_) {
  receiver_.monitor(state_);
  buttons_ = subscribeGuarded<OmniButtonEvent>(cycle.bus(), config.device + "/button", 10,
                                               [this, &cycle](const OmniButtonEvent& event, const std::string& sender) {
                                                 button_senders_.receive(sender, cycle.bus().now());
                                                 clutch_ = pressed(event, config_.clutch_button);
                                                 operator_present_ = pressed(event, config_.operator_button);
                                               });
}

std::optional<HandReading> OmniAdapter::read(const Cycle::Tick& tick) {
  const OmniState* state = state_.get(tick.now);
  const std::string rivals =
      button_senders_.hasOther() ? button_senders_.rivals(tick.now, buttons_.publishers() > 1) : "";
  rivals_ = rivals.empty() ? "" : config_.device + "/button is sent by two nodes, " + rivals;
  if (!state || !rivals.empty()) {
    operator_present_ = false;
    return std::nullopt;
  }
  if (!receiver_.isConnected()) return std::nullopt;
  HandReading reading;
  reading.position = config_.length_unit * toVector(state->pose.position);
  if (!isWithin(reading.position, kLargestHandDistance)) return std::nullopt;
  reading.stamp = state->header.stamp;
  reading.clutch = clutch_;
  reading.operator_present = operator_present_ || config_.operator_button == "none";
  return reading;
}

void OmniAdapter::render(const Eigen::Vector3d& force, const Cycle::Tick&) {
  OmniFeedback feedback;
  feedback.force = toMessage<geometry_msgs::Vector3>(force);
  force_.publish(feedback);
}

}  // namespace microinjection
