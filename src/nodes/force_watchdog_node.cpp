#include "nodes/force_watchdog_node.h"

#include "nodes/runtime/node_parameters.h"
#include "nodes/runtime/run_node.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {

const char* const ForceWatchdogNode::kHelp =
    "force_watchdog: publishes zero force to a haptic device while no other node publishes a force.\n"
    "In and out: /haptic/servo_cf, or /DEVICE/force_feedback of a driver.\n"
    "Parameters:\n"
    "  ~kind        of the device: crtk (default), omni or geomagic\n"
    "  ~device      namespace of the driver's topics; default haptic for crtk, else that of the adapter\n"
    "  ~force       for crtk: topic of the force below the device, default servo_cf\n"
    "  ~from_start  also before another node's first force, default true; false for an arm that falls at\n"
    "               the first force unless it has its settings\n"
    "  ~timeout     s without a force of another node, default 0.05\n"
    "  ~rate        Hz, of checks and of zero force, default 200\n";

ForceWatchdogNode::Parameters ForceWatchdogNode::Parameters::read(const ros::NodeHandle& node,
                                                                  const ros::NodeHandle& private_node) {
  Parameters parameters;
  ConfigReader reader = parameterReader(private_node);
  reader.choice("kind", parameters.kind, {"crtk", "omni", "geomagic"});
  if (parameters.kind != "crtk") node.getParam("haptic_device/device", parameters.device);
  reader.text("device", parameters.device);
  reader.text("force", parameters.force);
  reader.boolean("from_start", parameters.from_start);
  if (parameters.kind != "crtk" && parameters.force != "servo_cf") reader.error("force", "is a key of kind: crtk only");
  reader.number("timeout", parameters.timeout, Range::positive());
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  reader.finish();
  return parameters;
}

ForceWatchdogNode::ForceWatchdogNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : parameters_(Parameters::read(node, private_node)),
      force_(MonitoredForce::make(parameters_.kind, parameters_.device, parameters_.force, node,
                                  [this] { last_received_ = ros::Time::now(); })) {}

void ForceWatchdogNode::run() {
  // Uses wall time: it must also work when nothing else does.
  for (ros::WallRate rate(parameters_.rate); ros::ok() && !master_.masterLostForLong(); rate.sleep()) {
    ros::spinOnce();
    const ros::Time now = ros::Time::now();
    if (last_received_.isZero() && !parameters_.from_start) continue;
    if (secondsBetween(last_received_, now) >= parameters_.timeout) force_->publishZeroForce(now);
  }
}

}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::ForceWatchdogNode>(argc, argv, "force_watchdog");
}
