#pragma once

#include <set>
#include <string>

namespace microinjection {

/// Nodes tell the clock on this topic that they have done the tick `stamp`; frame_id is the node's name, stamp 0 means
/// that it is ready for the first.
constexpr char kAcknowledgementTopic[] = "/lockstep/acknowledgement";

/// The clock tells on this latched topic (std_msgs/String) the names of the participants that are gone, all of them,
/// each with a space behind it: nobody waits for their messages any more.
constexpr char kLeftTopic[] = "/lockstep/left";

/// Whoever watches the participants (a supervisor, a test) tells the clock on this topic (std_msgs/String) the name of
/// one that is frozen: it leaves at once, as if it had been killed.
constexpr char kLeaveTopic[] = "/lockstep/leave";

/// Names of the nodes that step together, from the parameter /lockstep/participants; empty when the session is live.
std::set<std::string> lockstepParticipants();

/// Whether this node is one of them.
bool takesPartInLockstep();

}  // namespace microinjection
