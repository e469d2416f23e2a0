#pragma once

#include <string>

#include "nodes/bus/bus.h"

namespace microinjection {

/// Local date and time, ISO 8601. In virtual time the session's, as UTC, so that all runs write the same.
std::string localTime(const Bus& bus);

}  // namespace microinjection
