#include "operation/teleoperation/two_port.h"

#include <algorithm>

namespace microinjection {
namespace {

// Share of the reserve that is planned with; the rest is for what the prediction of a period misses.
constexpr double kSpent = 0.5;

}  // namespace

TwoPortConfig TwoPortConfig::read(ConfigReader reader) {
  TwoPortConfig config;
  reader.boolean("enabled", config.enabled);
  reader.number("reserve", config.reserve, Range::positive());
  reader.number("speed_limit", config.speed_limit, Range::positive());
  config.gate = EnergyGateConfig::read(reader);
  reader.number("timeout", config.timeout, Range::positive());
  return config;
}

void PacketInbox::receive(const TeleoperationPacket& packet) {
  energy_ = std::max(energy_, packet.energy);
  if (packet.sequence <= sequence_) return;
  sequence_ = packet.sequence;
  value_ = packet.value;
  age_ = 0;
}

std::optional<Eigen::Vector3d> PacketInbox::value(double timeout) const {
  if (sequence_ == 0 || age_ > timeout) return std::nullopt;
  return value_;
}

std::optional<Eigen::Vector3d> LeaderPort::step(const Eigen::Vector3d& position, double dt) {
  const Eigen::Vector3d way = known_ ? Eigen::Vector3d(position - last_) : Eigen::Vector3d::Zero();
  last_ = position;
  known_ = true;
  velocity_.add(position, dt);
  inbox_.age(dt);
  const double given = force_.dot(way);  // to the hand
  out_ += std::max(0.0, given);
  outgoing_.energy += std::max(0.0, -given);
  outgoing_.value = position;
  ++outgoing_.sequence;

  const std::optional<Eigen::Vector3d> received = inbox_.value(config_.timeout);
  force_ = received.value_or(Eigen::Vector3d::Zero());
  if (!received) return std::nullopt;
  if (!config_.enabled) return force_;
  force_ = gate_.step(force_, velocity_.value(), margin() + kSpent * config_.reserve, dt);
  return force_;
}

Eigen::Vector3d FollowerPort::allowed(const Eigen::Vector3d& move, const Eigen::Vector3d& force) const {
  if (!config_.enabled) return move;
  const double size = force.norm();
  const double needed = -force.dot(move);  // J into what is touched
  const double spare = std::max(0.0, margin() + kSpent * config_.reserve);
  if (size == 0 || needed <= spare) return move;
  return move + (needed - spare) / (size * size) * force;
}

std::optional<Eigen::Vector3d> FollowerPort::step(const Eigen::Vector3d& force, double dt) {
  // The force rises or falls along the move: the trapezium counts a spring's energy exactly.
  const double given = -0.5 * (force_ + force).dot(move_);
  out_ += std::max(0.0, given);
  outgoing_.energy += std::max(0.0, -given);
  outgoing_.value = force;
  ++outgoing_.sequence;
  inbox_.age(dt);
  force_ = force;
  move_.setZero();

  const std::optional<Eigen::Vector3d> goal = inbox_.value(config_.timeout);
  if (!goal) return std::nullopt;
  if (!begun_) position_ = *goal;
  begun_ = true;
  move_ = *goal - position_;
  const double longest = config_.speed_limit * dt;
  if (config_.enabled && move_.norm() > longest) move_ *= longest / move_.norm();
  move_ = allowed(move_, force);
  position_ += move_;
  return position_;
}

}  // namespace microinjection
