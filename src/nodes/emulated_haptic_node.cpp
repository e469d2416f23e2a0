#include "nodes/emulated_haptic_node.h"

#include <algorithm>

#include "nodes/node_parameters.h"

namespace microinjection {

const char* const EmulatedHapticNode::kHelp =
    "emulated_haptic: a haptic device that is not there, behind the topics of its driver, in a virtual hand that\n"
    "follows a recorded motion; measures the time from its pose to the force that comes back.\n"
    "Parameters: ~kind (crtk|omni|geomagic), ~motion (file, required), ~start_delay (s), ~mass (kg),\n"
    "~damping (N s/m), ~stiffness (N/m), ~rate (Hz).\n";

EmulatedHapticNode::Parameters EmulatedHapticNode::Parameters::read(const ros::NodeHandle& private_node) {
  Parameters parameters;
  ConfigReader reader = parameterReader(private_node);
  reader.choice("kind", parameters.kind, emulatedDrivers());
  reader.text("motion", parameters.motion, ConfigReader::kRequired);
  reader.number("start_delay", parameters.start_delay, Range::nonNegative());
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  parameters.hand = VirtualHandConfig::read(reader);
  reader.finish();
  return parameters;
}

EmulatedHapticNode::EmulatedHapticNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : parameters_(Parameters::read(private_node)),
      motion_(HandMotion::load(parameters_.motion)),
      hand_(parameters_.hand, motion_.at(0).position),
      cycle_(node, parameters_.rate),
      meter_(cycle_.node()),
      driver_(makeEmulatedDriver(parameters_.kind, cycle_.node(), [this](const auto& force, const ros::Time& received) {
        force_ = force;
        meter_.felt(force, received);
      })) {
  report("device to bridge", meter_.atBridge());
  report("device to device", meter_.atDevice());
}

void EmulatedHapticNode::report(const std::string& name, const IntervalHistogram& trips) {
  cycle_.diagnostics().add(name, [&trips](auto& status) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "from the hand's pose to the force that depends on it");
    CycleDiagnostics::reportIntervals(trips, status);
    status.add("longest (s)", trips.largest());
  });
}

void EmulatedHapticNode::run() {
  cycle_.run([this](const Cycle::Tick& tick) { step(tick); });
}

void EmulatedHapticNode::step(const Cycle::Tick& tick) {
  elapsed_ += tick.dt;
  const HandMotion::Sample meant = motion_.at(std::max(0.0, elapsed_ - parameters_.start_delay));
  hand_.step(meant.position, force_.allFinite() ? force_ : Eigen::Vector3d::Zero(), tick.dt);
  driver_->tell(hand_.position(), meant.clutch, tick.now);
  meter_.step(tick.now);
}

}  // namespace microinjection
