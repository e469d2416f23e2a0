#include "nodes/link/remote_peer.h"

#include <limits>

#include "nodes/link/link_messages.h"

namespace microinjection {

RemotePeer::RemotePeer(Cycle& cycle, const LinkConfig& link, const HapticBridgeConfig& bridge)
    : model_(link, bridge.motion.position_scale, bridge.force_gain, epochTime(cycle.bus())),
      force_gain_(bridge.force_gain),
      sent_(cycle.output<cell_microinjection::LinkPacket>("link/hand/sent")) {
  cycle
      .input<cell_microinjection::LinkPacket>("link/hand/received", InputPhase::kSampled,
                                              std::numeric_limits<double>::infinity())
      .onMessage([this, &bus = cycle.bus()](const auto& message, const ros::Time&) {
        if (isPlausible(bus, "link/hand/received", message)) model_.receive(toPacket(message));
      });
}

void RemotePeer::read(HapticBridge::Input& input, const Cycle::Tick& tick) {
  const auto force = model_.step(tick.dt);
  input.needle = model_.needle();
  // The rig's side has chosen the source.
  if (force) input.force.predicted = input.force.measured = *force / force_gain_;
}

void RemotePeer::send(const std::optional<Eigen::Vector3d>& target, const ros::Time&, const Cycle::Tick& tick) {
  model_.setTarget(target);
  cell_microinjection::LinkPacket message = toMessage(model_.packet());
  message.header.stamp = tick.now;
  sent_.publish(message);
}

void RemotePeer::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  status.add("age of the rig's packet (s)", model_.packetAge());
  status.add("round trip (periods)", model_.roundTrip());
}

}  // namespace microinjection
