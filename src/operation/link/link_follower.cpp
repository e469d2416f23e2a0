#include "operation/link/link_follower.h"

#include <cmath>
#include <limits>

namespace microinjection {
namespace {

// A follower whose first packet of an epoch has a later number than this cannot join the epoch.
constexpr std::uint64_t kJoinLimit = 1000;

bool valid(const std::optional<Eigen::Vector3d>& value) { return value && value->allFinite(); }

}  // namespace

LinkFollower::LinkFollower(const LinkConfig& config)
    : config_(config), wave_(config.wave), packet_age_(std::numeric_limits<double>::infinity()) {}

void LinkFollower::receive(const LinkPacket& packet) {
  // A packet with an invalid scale is ignored.
  if (!(packet.position_scale > 0 && std::isfinite(packet.force_gain)) || packet.epoch < last_received_.epoch) return;
  if (packet.epoch > last_received_.epoch) {
    // Begins the epoch here and not in step(): its packets until then must not be lost.
    wave_.reset(Eigen::Vector3d::Zero());
    outgoing_.follows = false;
    last_received_ = packet;
    last_received_.number = 0;
    // This follower started in the midst of the epoch: the earlier waves are unknown.
    if (packet.wave.sequence > kJoinLimit) ended_epoch_ = packet.epoch;
  }
  wave_.receive(packet.wave);
  if (packet.number <= last_received_.number) return;
  last_received_ = packet;
  packet_age_ = 0;
}

std::string LinkFollower::holdReason(const Input& input) const {
  if (packet_age_ > config_.timeout) return "no packets from the hand's side";
  if (!valid(input.needle)) return "no valid needle position";
  if (!valid(input.force)) return "no valid force";
  if (!input.controller) return "the controller is silent";
  if (!last_received_.follows) return "the hand's side holds";
  return last_received_.epoch == ended_epoch_ ? "the hand has to be taken up again" : "";
}

std::optional<Eigen::Vector3d> LinkFollower::step(const Input& input, double dt) {
  packet_age_ += dt;
  outgoing_.epoch = last_received_.epoch;
  outgoing_.valid = input.controller && valid(input.needle) && valid(input.force);
  if (outgoing_.valid) outgoing_.needle = *input.needle;
  hold_reason_ = holdReason(input);
  if (!hold_reason_.empty()) {
    if (outgoing_.follows) ended_epoch_ = last_received_.epoch;
    outgoing_.follows = false;
    return std::nullopt;
  }
  if (!outgoing_.follows) wave_.begin(*input.needle / last_received_.position_scale);
  outgoing_.follows = true;
  return Eigen::Vector3d(last_received_.position_scale * wave_.step(last_received_.force_gain * *input.force, dt));
}

LinkPacket LinkFollower::packet() {
  ++outgoing_.number;
  outgoing_.wave = wave_.packet();
  return outgoing_;
}

}  // namespace microinjection
