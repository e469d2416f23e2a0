#pragma once

#include "benchmark/paper/tensegrity_common.h"

namespace microinjection {

/// Sizes and form of the structure, stable time step, and processor times of a served needle.
void writeNumbers(const TensegrityStudy& study);

}  // namespace microinjection
