#pragma once

#include "base/config_reader.h"
#include "nodes/bus/bus.h"

namespace microinjection {

/// A strict reader of a node's own parameters; its messages name the node. `diagnostic_period`, which
/// belongs to Diagnostics, is left out.
ConfigReader parameterReader(const Bus& bus);

}  // namespace microinjection
