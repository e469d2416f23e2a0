#include "nodes/link/link_messages.h"

#include <cmath>

#include "nodes/runtime/conversions.h"
#include "nodes/runtime/finite_message.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {
namespace {

template <typename Message>
void assign(Message& message, const Eigen::Vector3d& vector) {
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
}

/// Limit of a wave's integral (J^0.5 s^0.5), its energy (J) and the scales: beyond any real value,
/// and small enough for squares.
constexpr double kLargestOfLink = 1e12;

template <typename Vector>
bool isWithin(const Vector& vector, double largest) {
  return std::abs(vector.x) <= largest && std::abs(vector.y) <= largest && std::abs(vector.z) <= largest;
}

}  // namespace

std::uint64_t epochTime(const Bus& bus) { return bus.isVirtual() ? bus.now().toNSec() : ros::WallTime::now().toNSec(); }

bool isPlausible(Bus& bus, const std::string& topic, const cell_microinjection::LinkPacket& message) {
  // Epochs count from the time at the start of the hand's side. A later one would lock all others out.
  const std::uint64_t latest = epochTime(bus) + static_cast<std::uint64_t>(1e9 * kLargestLead);
  const bool good = message.epoch <= latest && isFinite(message) && isWithin(message.wave, kLargestOfLink) &&
                    std::abs(message.energy) <= kLargestOfLink && std::abs(message.position_scale) <= kLargestOfLink &&
                    std::abs(message.force_gain) <= kLargestOfLink && isWithin(message.needle, kLargestNeedleDistance);
  if (!good) bus.refusals().add(topic, "its numbers are beyond the limits of a hand and a rig");
  return good;
}

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
  message.valid = packet.valid;
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
  packet.valid = message.valid;
  packet.needle = {message.needle.x, message.needle.y, message.needle.z};
  return packet;
}

}  // namespace microinjection
