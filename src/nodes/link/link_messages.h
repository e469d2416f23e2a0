#pragma once

#include <cstdint>
#include <string>

#include "cell_microinjection/LinkPacket.h"
#include "nodes/bus/bus.h"
#include "operation/link/link_packet.h"

namespace microinjection {

/// The caller sets the message's header.
cell_microinjection::LinkPacket toMessage(const LinkPacket& packet);

LinkPacket toPacket(const cell_microinjection::LinkPacket& message);

/// The time (ns) that epochs count from. It is the wall's, in virtual time the session's, since a restarted bridge must
/// continue the count; in virtual time it is the session's.
std::uint64_t epochTime(const Bus& bus);

/// Whether epoch, wave, energy, scales and needle of a packet are within the limits of any hand and
/// rig. An implausible packet is reported as refused on `topic`.
bool isPlausible(Bus& bus, const std::string& topic, const cell_microinjection::LinkPacket& message);

}  // namespace microinjection
