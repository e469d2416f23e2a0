#pragma once

#include <memory>

#include "cell/identification/table_law.h"
#include "cell/model/scene.h"

namespace microinjection {

/// The force on the tip of the scene's cell for a modulus of 1 Pa of its outermost layer, solved as `indent`
/// does: at 16 depths to `deepest` (m), the ratios of all moduli held. `live`: by the P1 tetrahedra of a live
/// session. Minutes at the most. Throws ConfigError when the force is not proportional to the modulus, or
/// no depth has a solution.
std::shared_ptr<ElasticLaw> solveSceneLaw(const Scene& scene, bool live, double deepest);

}  // namespace microinjection
