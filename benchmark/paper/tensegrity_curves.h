#pragma once

#include "benchmark/paper/tensegrity_common.h"

namespace microinjection {

/// Figures 12 and 13: force over depth, by prestress, by how strong the members are, and by the
/// struts' material.
void writeCurves(const TensegrityStudy& study);

}  // namespace microinjection
