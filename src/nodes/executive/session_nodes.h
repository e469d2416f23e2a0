#pragma once

#include "nodes/executive/executive.h"
#include "session/session_plan.h"

namespace microinjection {

/// Name of the node that publishes the frames of the rig, in place of processes that are no nodes of ours.
constexpr char kRigFrames[] = "rig_frames";

/// Adds the nodes of a plan for SessionClock::kVirtual. @throws ConfigError naming the node that does not start
void addNodes(Executive& executive, const SessionPlan& plan);

}  // namespace microinjection
