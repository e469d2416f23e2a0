#include "nodes/link_emulator_node.h"

#include <limits>
#include <string>

#include "nodes/runtime/node_parameters.h"

namespace microinjection {
namespace {

constexpr double kRate = 1000;              // Hz
constexpr unsigned kOtherDirection = 1000;  // added to the seed

LinkConditions readConditions(const Bus& bus) {
  ConfigReader reader = parameterReader(bus);
  const LinkConditions conditions = LinkConditions::read(reader);
  reader.finish();
  return conditions;
}

LinkConditions otherDirection(LinkConditions conditions) {
  conditions.seed += kOtherDirection;
  return conditions;
}

}  // namespace

const char* const LinkEmulatorNode::kHelp =
    "link_emulator: a network between haptic_bridge and teleoperation_follower, with delay, jitter and loss.\n"
    "In: /link/hand/sent /link/rig/sent /link/plugged (Bool). Out: /link/rig/received /link/hand/received.\n"
    "Parameters, each direction with its own random numbers:\n"
    "  ~delay   s, one way\n"
    "  ~jitter  s, one way\n"
    "  ~loss    share of the packets, 0 to 1\n"
    "  ~seed    of the random numbers\n";

LinkEmulatorNode::LinkEmulatorNode(Bus& bus)
    : conditions_(readConditions(bus)),
      cycle_(bus, kRate),
      to_rig_(conditions_),
      to_hand_(otherDirection(conditions_)),
      rig_received_(cycle_.output<Message>("link/rig/received")),
      hand_received_(cycle_.output<Message>("link/hand/received")) {
  const auto relay = [this](const std::string& topic, LinkEmulator<Message>& link) {
    cycle_.input<Message>(topic, InputPhase::kSampled, std::numeric_limits<double>::infinity())
        .onMessage([&link](const Message& message, const ros::Time& now) { link.send(message, now.toSec()); });
  };
  plug_ = subscribeGuarded<std_msgs::Bool>(
      bus, "link/plugged", 10, [this](const std_msgs::Bool& plugged, const std::string&) { plugged_ = plugged.data; });
  relay("link/hand/sent", to_rig_);
  relay("link/rig/sent", to_hand_);
  cycle_.onStep([this](const Cycle::Tick& tick) { step(tick); });
}

void LinkEmulatorNode::step(const Cycle::Tick& tick) {
  if (!plugged_) {
    to_rig_.receive(tick.now.toSec());
    to_hand_.receive(tick.now.toSec());
    return;
  }
  for (const Message& message : to_rig_.receive(tick.now.toSec())) rig_received_.publish(message);
  for (const Message& message : to_hand_.receive(tick.now.toSec())) hand_received_.publish(message);
}

}  // namespace microinjection
