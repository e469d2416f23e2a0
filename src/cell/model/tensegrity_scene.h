#pragma once

#include "base/config_reader.h"
#include "cell/tensegrity/tensegrity_config.h"

namespace microinjection {

/// Reads `cell: {model: tensegrity, ...}` of a scene file. Filament counts and prestrains are
/// required; the values of Table II are defaults.
void readTensegrity(ConfigReader& cell, TensegrityConfig& value);

}  // namespace microinjection
