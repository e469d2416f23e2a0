#include "nodes/force_sensor_node.h"

#include "nodes/conversions.h"
#include "nodes/node_parameters.h"

namespace microinjection {

const char* const ForceSensorNode::kHelp =
    "force_sensor: a virtual two-axis MEMS force sensor at the pipette.\n"
    "In: /cell/predicted_cf, /needle/measured_cp. Out: /force_sensor/measured_cf (needle_tip: z along, x across).\n"
    "Parameters: see config/force_sensor.yaml.\n";

ForceSensorNode::Parameters ForceSensorNode::Parameters::read(const ros::NodeHandle& private_node) {
  Parameters parameters;
  ConfigReader reader = parameterReader(private_node);
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  reader.number("input_timeout", parameters.input_timeout, Range::positive());
  parameters.model = ForceSensorConfig::read(reader);
  reader.finish();
  return parameters;
}

ForceSensorNode::ForceSensorNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : parameters_(Parameters::read(private_node)),
      model_(parameters_.model),
      cycle_(node, parameters_.rate),
      force_(
          cycle_.input<geometry_msgs::WrenchStamped>("cell/predicted_cf", Phase::kSameTick, parameters_.input_timeout)),
      needle_(cycle_.input<geometry_msgs::PoseStamped>("needle/measured_cp", Phase::kTickBefore,
                                                       parameters_.input_timeout)),
      measured_(cycle_.output<geometry_msgs::WrenchStamped>("force_sensor/measured_cf")) {
  cycle_.diagnostics().add("sensor", [this](auto& status) { report(status); });
}

void ForceSensorNode::run() {
  cycle_.run([this](const Cycle::Tick& tick) { step(tick); });
}

void ForceSensorNode::step(const Cycle::Tick& tick) {
  const auto pose = trustedPose(needle_.get(tick.now));
  const auto* message = force_.get(tick.now);
  const auto force = pose ? trustedForce(message, pose->linear()) : std::nullopt;
  if (!force) {
    untrusted_ = pose ? "no trusted force" : "no trusted needle pose";
    measured_.publishInvalid(toWrench(Eigen::Vector3d::Zero(), tick.now, kTipFrame));
    return;
  }
  untrusted_.clear();
  const Eigen::Vector3d at_tip = pose->linear().transpose() * *force;
  const Eigen::Vector2d reading = model_.sample({at_tip.z(), at_tip.x()}, tick.dt);
  measured_.publish(toWrench({reading[1], 0, reading[0]}, message->header.stamp, kTipFrame));
}

void ForceSensorNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const bool good = untrusted_.empty() && !model_.saturated();
  status.summary(good ? diagnostic_msgs::DiagnosticStatus::OK : diagnostic_msgs::DiagnosticStatus::WARN,
                 good                 ? "measures"
                 : untrusted_.empty() ? "saturated"
                                      : untrusted_);
}

}  // namespace microinjection
