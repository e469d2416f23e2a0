#pragma once

#include <string>

#include "cell_microinjection/LinkPacket.h"
#include "operation/teleoperation/link_packet.h"

namespace microinjection {

/// The message's header is left to who sends it.
cell_microinjection::LinkPacket toMessage(const LinkPacket& packet);

LinkPacket toPacket(const cell_microinjection::LinkPacket& message);

/// Whether epoch, wave, energy, scales and needle of a packet can be those of a hand and a rig. A packet that is not
/// plausible is reported as refused on `topic`.
bool isPlausible(const std::string& topic, const cell_microinjection::LinkPacket& message);

}  // namespace microinjection
