#include "operation/link/link_leader.h"

#include <limits>

namespace microinjection {

LinkLeader::LinkLeader(const LinkConfig& config, double position_scale, double force_gain, std::uint64_t first_epoch)
    : config_(config), wave_(config.wave), packet_age_(std::numeric_limits<double>::infinity()) {
  outgoing_.epoch = first_epoch;
  outgoing_.position_scale = position_scale;
  outgoing_.force_gain = force_gain;
}

void LinkLeader::receive(const LinkPacket& packet) {
  if (outgoing_.follows && packet.epoch == outgoing_.epoch) wave_.receive(packet.wave);
  if (packet.number <= last_received_.number && packet_age_ <= config_.timeout) return;  // a restarted rig counts anew
  last_received_ = packet;
  packet_age_ = 0;
  if (!outgoing_.follows || packet.epoch != outgoing_.epoch) return;
  followed_ = followed_ || packet.follows;
  lost_ = lost_ || (followed_ && !packet.follows);
}

std::optional<Eigen::Vector3d> LinkLeader::needle() const {
  if (packet_age_ > config_.timeout || !last_received_.valid || lost_) return std::nullopt;
  return last_received_.needle;
}

std::optional<Eigen::Vector3d> LinkLeader::step(double dt) {
  packet_age_ += dt;
  if (outgoing_.follows) {
    waiting_time_ = followed_ ? 0 : waiting_time_ + dt;
    lost_ = lost_ || packet_age_ > config_.timeout || waiting_time_ > config_.timeout + 1;
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
  waiting_time_ = 0;
}

LinkPacket LinkLeader::packet() {
  ++outgoing_.number;
  outgoing_.wave = wave_.packet();
  return outgoing_;
}

}  // namespace microinjection
