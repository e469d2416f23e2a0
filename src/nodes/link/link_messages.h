#pragma once

#include <string>

#include "cell_microinjection/LinkPacket.h"
#include "operation/link/link_packet.h"

namespace microinjection {

/// The caller sets the message's header.
cell_microinjection::LinkPacket toMessage(const LinkPacket& packet);

LinkPacket toPacket(const cell_microinjection::LinkPacket& message);

/// Whether epoch, wave, energy, scales and needle of a packet are within the limits of any hand and
/// rig. An implausible packet is reported as refused on `topic`.
bool isPlausible(const std::string& topic, const cell_microinjection::LinkPacket& message);

}  // namespace microinjection
