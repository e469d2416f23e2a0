#pragma once

#include "session/session.h"

namespace microinjection {

/// Throws ConfigError with a line for each combination that cannot be.
void checkSession(const Session& session);

}  // namespace microinjection
