#include "benchmark/emulated_haptic/emulated_haptic_node.h"

#include <algorithm>

#include "nodes/runtime/conversions.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {

const char* const EmulatedHapticNode::kHelp =
    "emulated_haptic: emulates a haptic device, its driver's topics and a hand that follows a recorded motion;\n"
    "measures the time from the device's pose to the resulting force.\n"
    "Parameters: ~kind (crtk|omni|geomagic|force_dimension|dvrk|dvrk_2_0|falcon|joy|spacenav), ~motion (file, "
    "required), ~start_delay (s), ~mass (kg),\n"
    "~damping (N s/m), ~stiffness (N/m), ~rate (Hz).\n";

EmulatedHapticNode::Parameters EmulatedHapticNode::Parameters::read(const Bus& bus) {
  Parameters parameters;
  ConfigReader reader = parameterReader(bus);
  reader.choice("kind", parameters.kind, emulatedDrivers());
  reader.text("motion", parameters.motion, ConfigReader::kRequired);
  reader.number("start_delay", parameters.start_delay, Range::nonNegative());
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  parameters.hand = VirtualHandConfig::read(reader);
  reader.finish();
  return parameters;
}

EmulatedHapticNode::EmulatedHapticNode(Bus& bus)
    : parameters_(Parameters::read(bus)),
      motion_(HandMotion::load(parameters_.motion)),
      hand_(parameters_.hand, motion_.at(0).position),
      cycle_(bus, parameters_.rate),
      meter_(bus),
      driver_(makeEmulatedDriver(
          parameters_.kind, cycle_,
          [this](const auto& force, const ros::Time& received) { meter_.addForce(force, received); })),
      force_(cycle_.output<geometry_msgs::WrenchStamped>("emulated_haptic/measured_cf")),
      phase_(cycle_.output<cell_microinjection::StringStamped>("virtual_hand/phase", true)) {
  at_.position = hand_.position();
  report("device to bridge", meter_.atBridge());
  report("device to device", meter_.atDevice());
  cycle_.onStep([this](const Cycle::Tick& tick) { step(tick); });
}

void EmulatedHapticNode::report(const std::string& name, const IntervalHistogram& trips) {
  cycle_.diagnostics().add(name, [&trips](auto& status) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "from the hand's pose to the force that depends on it");
    CycleDiagnostics::reportIntervals(trips, status);
    status.add("longest (s)", trips.largest());
  });
}

void EmulatedHapticNode::step(const Cycle::Tick& tick) {
  elapsed_ += tick.dt;
  const double time = std::max(0.0, elapsed_ - parameters_.start_delay);
  const HandMotion::Sample intended = motion_.at(time);
  driver_->process(at_);
  const Eigen::Vector3d force = driver_->render(at_);
  const Eigen::Vector3d before = hand_.position();
  hand_.step(intended.position, force.allFinite() ? force : Eigen::Vector3d::Zero(), tick.dt);
  at_.position = hand_.position();
  at_.velocity = (at_.position - before) / tick.dt;
  at_.clutch = intended.clutch;
  at_.present = elapsed_ >= parameters_.start_delay / 2 && intended.phase != "away";
  at_.inject = intended.phase == "inject";
  driver_->publish(at_, tick.now);
  force_.publish(toWrench(force, tick.now, "view"));
  publishPhase(tick.now, time >= motion_.duration() ? "done" : intended.phase);
  meter_.step(tick.now);
}

void EmulatedHapticNode::publishPhase(const ros::Time& now, const std::string& phase) {
  if (phase_published_ == phase) return;
  cell_microinjection::StringStamped message;
  message.header.stamp = now;
  message.string = phase;
  phase_.publish(message);
  phase_published_ = phase;
}

}  // namespace microinjection
