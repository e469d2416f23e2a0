#pragma once

#include "cell/identification/force_curve.h"

namespace microinjection {

/// Leaves out all but the first of equal readings in a row, if the sensor hung: at least ten of them,
/// with a jump behind them that noise and the converter's step do not make. A coarse converter repeats
/// readings without such jumps. Adds a note.
ForceCurve withoutFrozenReadings(const ForceCurve& curve);

}  // namespace microinjection
