#include "operation/link/wave_port.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

/// Adds a wave (sqrt(W)) of a period dt (s) to the packet.
void send(TeleoperationPacket& packet, const Eigen::Vector3d& wave, double dt) {
  packet.value += dt * wave;
  packet.energy += 0.5 * wave.squaredNorm() * dt;
  ++packet.sequence;
}

}  // namespace

WaveConfig WaveConfig::read(ConfigReader reader) {
  WaveConfig config;
  reader.number("impedance", config.impedance, Range::positive());
  reader.number("stiffness", config.stiffness, Range::positive());
  reader.number("lateness", config.lateness, Range::nonNegative());
  reader.number("damping", config.damping, Range::nonNegative());
  reader.number("matching", config.matching, Range::closed(0, 1));
  reader.number("contact_force", config.contact_force, Range::positive());
  config.receiver = WaveReceiverConfig::read(reader);
  return config;
}

void WaveLeader::reset(const Eigen::Vector3d& position) {
  receiver_.reset();
  round_trip_ = RoundTrip();
  outgoing_ = {};
  port_ = position;
}

void WaveLeader::receive(const TeleoperationPacket& packet) {
  receiver_.receive(packet);
  round_trip_.receive(outgoing_.sequence, packet.echo);
}

Eigen::Vector3d WaveLeader::step(const Eigen::Vector3d& position, double dt) {
  const double b = config_.impedance;
  const Eigen::Vector3d& incoming = receiver_.step(round_trip_.periods() * dt, dt);
  // Implicit in the spring: stiffness (position - port - v dt) = b v - sqrt(2 b) w.
  const Eigen::Vector3d velocity =
      (config_.stiffness * (position - port_) + std::sqrt(2 * b) * incoming) / (b + config_.stiffness * dt);
  port_ += dt * velocity;
  outgoing_.echo = receiver_.newest();
  send(outgoing_, std::sqrt(2 * b) * velocity - incoming, dt);
  return config_.stiffness * (port_ - position);
}

void WaveFollower::reset(const Eigen::Vector3d& position) {
  receiver_.reset();
  round_trip_ = RoundTrip();
  outgoing_ = {};
  position_ = position;
  contact_.reset();
}

void WaveFollower::receive(const TeleoperationPacket& packet) {
  receiver_.receive(packet);
  round_trip_.receive(outgoing_.sequence, packet.echo);
}

const Eigen::Vector3d& WaveFollower::step(const Eigen::Vector3d& force, double dt) {
  const double b = config_.impedance;
  const Eigen::Vector3d& incoming = receiver_.step(round_trip_.periods() * dt, dt);
  contact_.setForce(force);
  const double damping = config_.matching * b + std::min(config_.damping, config_.lateness * contact_.stiffness());
  const Eigen::Vector3d velocity = (std::sqrt(2 * b) * incoming + force) / (b + damping);
  position_ += dt * velocity;
  contact_.move(dt * velocity);
  outgoing_.echo = receiver_.newest();
  send(outgoing_, incoming + std::sqrt(2 / b) * (force - damping * velocity), dt);
  return position_;
}

}  // namespace microinjection
