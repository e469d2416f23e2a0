#pragma once

#include <string>

#include "benchmark/common/teleoperation_loop.h"

namespace microinjection {

/// Cells for the needle of a TeleoperationLoop. Each presses back with the force that the hand means to press with when
/// the needle is 0.2 radii deep, so that the loop's stiffness is the secant's there.
enum class TouchedCell {
  kAdhering,  ///< glued, on the axis, the needle rubs and adheres: served, with what families have lost on the way out
  kHeld,      ///< by suction, on the axis: the force that is served, corrected by the family of held forces
  kSliding,   ///< by suction, needle half a radius beside the axis: the cell slides in its seat
  kLoose      ///< on the dish, needle from above beside the cell's top: the cell is squeezed out and lost
};
inline constexpr TouchedCell kTouchedCells[] = {TouchedCell::kAdhering, TouchedCell::kHeld, TouchedCell::kSliding,
                                                TouchedCell::kLoose};

std::string name(TouchedCell cell);

/// @param stiffness N/m, of the loop. @param pressed N, at the hand: kPressedForce of the loop
TeleoperationLoop::Touched makeTouchedCell(TouchedCell cell, double stiffness, double pressed);

}  // namespace microinjection
