#pragma once

#include <string>
#include <vector>

#include "session/session_plan.h"

namespace microinjection {

/// Throws ConfigError when the session has parts that do not keep the time of a lock step over topics.
void requireLockstep(const Session& session);

/// The nodes that take part in the lock step, "/cell_simulator" and so on.
std::vector<std::string> lockstepParticipants(const SessionPlan& plan);

}  // namespace microinjection
