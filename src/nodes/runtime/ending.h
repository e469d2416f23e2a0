#pragma once

namespace microinjection {

/// For a node that has something to say before it ends, such as zero force to a driver that holds the last one: SIGINT,
/// SIGTERM and rosnode's kill then only ask it to end, a second one ends it. Call it between ros::init with
/// NoSigintHandler and the first node handle. (What a serial device hears of a program that was killed:
/// rig/serial/stop_guard.h.)
void endInGoodOrder();

/// Whether the node was asked to end.
bool shutdownRequested();

}  // namespace microinjection
