#include "nodes/force_watchdog_node.h"

#include "nodes/haptic/crtk_adapter.h"
#include "nodes/haptic/geomagic_adapter.h"
#include "nodes/haptic/omni_adapter.h"
#include "nodes/runtime/node_parameters.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {

const char* const ForceWatchdogNode::kHelp =
    "force_watchdog: publishes zero force to a haptic device while no other node publishes a force.\n"
    "In and out: /haptic/servo_cf, or /DEVICE/force_feedback of a driver.\n"
    "Parameters:\n"
    "  ~kind        of the device: crtk (default), omni or geomagic\n"
    "  ~device      namespace of the driver's topics; default: haptic, phantom or Geomagic, as ~kind is\n"
    "  ~force       for crtk: topic of the force below the device, default servo_cf\n"
    "  ~from_start  also before another node's first force, default true; false for an arm that falls at\n"
    "               the first force unless it has its settings\n"
    "  ~timeout     s without a force of another node, default 0.05\n"
    "  ~rate        Hz, of checks and of zero force, default 200\n";

ForceWatchdogNode::Parameters ForceWatchdogNode::Parameters::read(const Bus& bus) {
  Parameters parameters;
  ConfigReader reader = parameterReader(bus);
  reader.choice("kind", parameters.kind, {"crtk", "omni", "geomagic"});
  parameters.device = parameters.kind == "omni"       ? OmniConfig().device
                      : parameters.kind == "geomagic" ? GeomagicConfig().device
                                                      : CrtkConfig().device;
  reader.text("device", parameters.device);
  reader.text("force", parameters.force);
  reader.boolean("from_start", parameters.from_start);
  if (parameters.kind != "crtk" && parameters.force != "servo_cf") reader.error("force", "is a key of kind: crtk only");
  reader.number("timeout", parameters.timeout, Range::positive());
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  reader.finish();
  return parameters;
}

ForceWatchdogNode::ForceWatchdogNode(Bus& bus)
    : bus_(bus),
      parameters_(Parameters::read(bus)),
      force_(MonitoredForce::make(parameters_.kind, parameters_.device, parameters_.force, bus,
                                  [this] { last_received_ = bus_.steady(); })) {
  // No Cycle: it must also work when nothing else does. Forces that have arrived are heard before a step.
  bus.setStep(1 / parameters_.rate, [this](const ros::Time& now) { check(now); });
}

void ForceWatchdogNode::check(const ros::Time& now) {
  if (last_received_.isZero() && !parameters_.from_start) return;
  if (secondsBetween(last_received_, bus_.steady()) >= parameters_.timeout) force_->publishZeroForce(now);
}

}  // namespace microinjection
