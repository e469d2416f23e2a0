#pragma once

#include "benchmark/paper/tensegrity_common.h"

namespace microinjection {

/// Table II: sections, stiffnesses and Euler loads of the members, from the paper's moduli and
/// bending stiffnesses.
void writeMembers(const TensegrityStudy& study);

/// Bending stiffness of struts of tetrahedra over that of the beam, by number of filaments, slices
/// and element.
void writeBending(const TensegrityStudy& study);

}  // namespace microinjection
