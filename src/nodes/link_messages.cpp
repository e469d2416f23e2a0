#include "nodes/link_messages.h"

namespace microinjection {
namespace {

template <typename Message>
void assign(Message& message, const Eigen::Vector3d& vector) {
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
}

}  // namespace

cell_microinjection::LinkPacket toMessage(const LinkPacket& packet) {
  cell_microinjection::LinkPacket message;
  message.number = packet.number;
  message.epoch = packet.epoch;
  message.follows = packet.follows;
  message.wave_number = packet.wave.sequence;
  message.echo = packet.wave.echo;
  assign(message.wave, packet.wave.value);
  message.energy = packet.wave.energy;
  message.position_scale = packet.position_scale;
  message.force_gain = packet.force_gain;
  message.trusted = packet.trusted;
  assign(message.needle, packet.needle);
  return message;
}

LinkPacket toPacket(const cell_microinjection::LinkPacket& message) {
  LinkPacket packet;
  packet.number = message.number;
  packet.epoch = message.epoch;
  packet.follows = message.follows;
  packet.wave.sequence = message.wave_number;
  packet.wave.echo = message.echo;
  packet.wave.value = {message.wave.x, message.wave.y, message.wave.z};
  packet.wave.energy = message.energy;
  packet.position_scale = message.position_scale;
  packet.force_gain = message.force_gain;
  packet.trusted = message.trusted;
  packet.needle = {message.needle.x, message.needle.y, message.needle.z};
  return packet;
}

}  // namespace microinjection
