#pragma once

#include <string>

#include "cell/model/scene.h"

namespace microinjection {

/// One line with everything that determines the force of a converged solution except the needle's
/// contact point and path: layers, materials, holding pipette, tip and contact; exact. Scenes with
/// the same line are the same cell under the same tip.
std::string describeCellAndTip(const Scene& scene);

}  // namespace microinjection
