#pragma once

#include <set>
#include <string>

namespace microinjection {

/// Topic on which nodes acknowledge the tick `stamp` to the clock. frame_id is the node's name;
/// stamp 0: the node is ready for the first tick.
constexpr char kAcknowledgementTopic[] = "/lockstep/acknowledgement";

/// Latched topic (std_msgs/String) of the clock: the names of all participants that have left, each
/// with a space behind it. Nodes do not wait for their messages any more.
constexpr char kLeftTopic[] = "/lockstep/left";

/// Topic (std_msgs/String) on which a supervisor or a test publishes the name of a frozen
/// participant. It leaves at once, as if it had been killed.
constexpr char kLeaveTopic[] = "/lockstep/leave";

/// Names of the participants, from the parameter /lockstep/participants; empty in a live session.
std::set<std::string> lockstepParticipants();

/// Whether this node is one of them.
bool takesPartInLockstep();

}  // namespace microinjection
