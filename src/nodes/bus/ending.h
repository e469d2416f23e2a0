#pragma once

namespace microinjection {

/// For a node that publishes before it ends, such as zero force to a driver that holds the last
/// force. The first SIGINT, SIGTERM or rosnode kill then only requests the end, the second ends the
/// node. Call between ros::init with NoSigintHandler and the first node handle.
/// hardware/serial/stop_guard.h covers serial devices of a killed program.
void endInGoodOrder();

/// Whether the end was requested.
bool shutdownRequested();

}  // namespace microinjection
