#pragma once

#include "cell/identification/identification.h"

namespace microinjection {

/// The outermost layer's modulus that a force curve and the tongues of one cell tell together. The two are independent:
/// other instruments, and other parts of the cell. Each modulus is taken as normal in its logarithm, with the deviation
/// of its interval, and they are joined with the inverse of their variances; one whose interval is open on a side tells
/// nothing.
///
/// The two are inconsistent (Identification::consistent) when they differ by more than three of their joint deviations:
/// then the cell, the mouth or a scale of the images is not that of the scene. `misfit` and `scatter` of the result are
/// relative: the difference and its deviation.
/// @pre each has an estimate young_modulus
Identification combineModuli(const Identification& force, const Identification& tongue);

}  // namespace microinjection
