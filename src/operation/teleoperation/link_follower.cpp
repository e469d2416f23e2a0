#include "operation/teleoperation/link_follower.h"

#include <cmath>
#include <limits>

namespace microinjection {
namespace {

// The packet of an epoch past which one cannot begin with it.
constexpr std::uint64_t kBeginning = 1000;

bool valid(const std::optional<Eigen::Vector3d>& value) { return value && value->allFinite(); }

}  // namespace

LinkFollower::LinkFollower(const LinkConfig& config)
    : config_(config), wave_(config.wave), age_(std::numeric_limits<double>::infinity()) {}

void LinkFollower::receive(const LinkPacket& packet) {
  // A scale that is no number counts as not heard.
  if (!(packet.position_scale > 0 && std::isfinite(packet.force_gain)) || packet.epoch < heard_.epoch) return;
  if (packet.epoch > heard_.epoch) {
    // What comes of the new epoch before the next step must not be lost.
    wave_.reset(Eigen::Vector3d::Zero());
    outgoing_.follows = false;
    heard_ = packet;
    heard_.number = 0;
    // Started in the midst of it: what the waves have done until now is not known.
    if (packet.wave.sequence > kBeginning) over_ = packet.epoch;
  }
  wave_.receive(packet.wave);
  if (packet.number <= heard_.number) return;
  heard_ = packet;
  age_ = 0;
}

std::string LinkFollower::holdReason(const Input& input) const {
  if (age_ > config_.timeout) return "the hand's side is not heard";
  if (!valid(input.needle)) return "no valid needle position";
  if (!valid(input.force)) return "no valid force";
  if (!input.controller) return "the controller is silent";
  if (!heard_.follows) return "the hand's side holds";
  return heard_.epoch == over_ ? "the hand has to be taken up again" : "";
}

std::optional<Eigen::Vector3d> LinkFollower::step(const Input& input, double dt) {
  age_ += dt;
  outgoing_.epoch = heard_.epoch;
  outgoing_.valid = input.controller && valid(input.needle) && valid(input.force);
  if (outgoing_.valid) outgoing_.needle = *input.needle;
  hold_reason_ = holdReason(input);
  if (!hold_reason_.empty()) {
    if (outgoing_.follows) over_ = heard_.epoch;
    outgoing_.follows = false;
    return std::nullopt;
  }
  if (!outgoing_.follows) wave_.begin(*input.needle / heard_.position_scale);
  outgoing_.follows = true;
  return Eigen::Vector3d(heard_.position_scale * wave_.step(heard_.force_gain * *input.force, dt));
}

LinkPacket LinkFollower::packet() {
  ++outgoing_.number;
  outgoing_.wave = wave_.packet();
  return outgoing_;
}

}  // namespace microinjection
