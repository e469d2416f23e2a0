#pragma once

#include "benchmark/paper/tensegrity_common.h"

namespace microinjection {

/// Figure 11: struts, cables and strut ends at rest and under its two loads.
void writeShapes(const TensegrityStudy& study);

}  // namespace microinjection
