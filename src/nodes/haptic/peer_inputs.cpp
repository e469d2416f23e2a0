#include "nodes/haptic/peer_inputs.h"

#include "nodes/runtime/conversions.h"

namespace microinjection {

void PeerTimeouts::read(ConfigReader& timeouts) {
  timeouts.number("needle", needle, Range::positive());
  timeouts.number("predicted", predicted, Range::positive());
  timeouts.number("measured", measured, Range::positive());
  timeouts.number("controller", controller, Range::nonNegative());
}

PeerInputs::PeerInputs(Cycle& cycle, const PeerTimeouts& timeouts, const ForceSourceConfig& source, bool quiet_sensor)
    : needle_(cycle.input<geometry_msgs::PoseStamped>("needle/measured_cp", InputPhase::kSampled, timeouts.needle)) {
  using geometry_msgs::WrenchStamped;
  if (source.usesPredicted()) {
    predicted_ = &cycle.input<WrenchStamped>("cell/predicted_cf", InputPhase::kSampled, timeouts.predicted);
    predicted_lives_.emplace(cycle, *predicted_, ForceLiveness::Source::kModel);
  }
  if (source.usesMeasured()) {
    measured_ = &cycle.input<WrenchStamped>("force_sensor/measured_cf", InputPhase::kSampled, timeouts.measured);
    measured_lives_.emplace(cycle, *measured_, sensorThatIs(quiet_sensor));
  }
  if (timeouts.controller > 0) {
    controller_ = &cycle.input<cell_microinjection::InjectionStatus>("controller/injection_state", InputPhase::kSampled,
                                                                     timeouts.controller);
  }
}

PeerInputs::Reading PeerInputs::read(const ros::Time& now) {
  Reading reading;
  reading.controller = !controller_ || controller_->get(now);
  const auto needle = validPose(needle_.get(now));
  const auto tip = needle ? std::optional<Eigen::Vector3d>(needle->translation()) : std::nullopt;
  if (predicted_lives_) predicted_lives_->step(tip);
  if (measured_lives_) measured_lives_->step(tip);
  if (needle) {
    reading.needle = needle->translation();
    reading.force.predicted = validForce(predicted_ ? predicted_->get(now) : nullptr, needle->linear());
    reading.force.measured = validForce(measured_ ? measured_->get(now) : nullptr, needle->linear());
  }
  return reading;
}

ros::Time PeerInputs::forceStamp(const ros::Time& now) const {
  return (predicted_ ? predicted_ : measured_)->get(now)->header.stamp;
}

}  // namespace microinjection
