#pragma once

#include "cell/identification/force_curve.h"

namespace microinjection {

/// Force (N) by which the way in and the way out differ far from the cell, less what a drift and the noise
/// explain: the medium's drag on lever and needle, which changes with the speed. `whole`: with the way out,
/// the position growing towards the cell. 0 where the record does not show it.
double dragOf(const ForceCurve& whole);

}  // namespace microinjection
