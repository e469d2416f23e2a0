#pragma once

#include <string>

#include "cell/model/scene.h"

namespace microinjection {

/// One line of all that determines the force of a converged solution but for the place and path of the needle: layers,
/// materials, holding pipette, tip and contact; exact. Two scenes with the same line are the same cell under the same
/// tip.
std::string describeCellAndTip(const Scene& scene);

}  // namespace microinjection
