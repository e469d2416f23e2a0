#pragma once

#include "base/config_reader.h"
#include "cell/tensegrity/tensegrity_config.h"

namespace microinjection {

/// Reads `cell: {model: tensegrity, ...}` of a scene file. What a member is made of and how it is prestressed must be
/// given: counts and prestrains have no default, the figures of Table II do.
void readTensegrity(ConfigReader& cell, TensegrityConfig& value);

}  // namespace microinjection
