#include "operation/teleoperation/link_leader.h"

#include <limits>

namespace microinjection {

LinkLeader::LinkLeader(const LinkConfig& config, double position_scale, double force_gain, std::uint64_t first_epoch)
    : config_(config), wave_(config.wave), age_(std::numeric_limits<double>::infinity()) {
  outgoing_.epoch = first_epoch;
  outgoing_.position_scale = position_scale;
  outgoing_.force_gain = force_gain;
}

void LinkLeader::receive(const LinkPacket& packet) {
  if (outgoing_.follows && packet.epoch == outgoing_.epoch) wave_.receive(packet.wave);
  if (packet.number <= heard_.number && age_ <= config_.timeout) return;  // a rig that was started again counts anew
  heard_ = packet;
  age_ = 0;
  if (!outgoing_.follows || packet.epoch != outgoing_.epoch) return;
  followed_ = followed_ || packet.follows;
  lost_ = lost_ || (followed_ && !packet.follows);
}

std::optional<Eigen::Vector3d> LinkLeader::needle() const {
  if (age_ > config_.timeout || !heard_.valid || lost_) return std::nullopt;
  return heard_.needle;
}

std::optional<Eigen::Vector3d> LinkLeader::step(double dt) {
  age_ += dt;
  if (outgoing_.follows) {
    waited_ = followed_ ? 0 : waited_ + dt;
    lost_ = lost_ || age_ > config_.timeout || waited_ > config_.timeout + 1;
  }
  if (!needle()) return std::nullopt;
  if (!outgoing_.follows) return Eigen::Vector3d(Eigen::Vector3d::Zero());
  return wave_.step(target_, dt);
}

void LinkLeader::setTarget(const std::optional<Eigen::Vector3d>& target) {
  const bool begins = target && !outgoing_.follows;
  outgoing_.follows = target.has_value();
  if (!target) {
    lost_ = false;
    return;
  }
  target_ = *target / outgoing_.position_scale;
  if (!begins) return;
  ++outgoing_.epoch;
  wave_.reset(target_);
  followed_ = lost_ = false;
  waited_ = 0;
}

LinkPacket LinkLeader::packet() {
  ++outgoing_.number;
  outgoing_.wave = wave_.packet();
  return outgoing_;
}

}  // namespace microinjection
