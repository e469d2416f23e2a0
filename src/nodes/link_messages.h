#pragma once

#include "cell_microinjection/LinkPacket.h"
#include "teleoperation/link_packet.h"

namespace microinjection {

/// The message's header is left to who sends it.
cell_microinjection::LinkPacket toMessage(const LinkPacket& packet);

/// What is not finite is left out by the link itself.
LinkPacket toPacket(const cell_microinjection::LinkPacket& message);

}  // namespace microinjection
