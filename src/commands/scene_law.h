#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cell/identification/elastic_law.h"
#include "cell/model/scene.h"

namespace microinjection {

/// The parameters of materials that solveSceneLaw() can free, those by which ogden and gent stiffen, and the values
/// with which it then solves the scene: about even in the logarithm, over all that stiffens at these depths.
const std::map<std::string, std::vector<double>>& freeMaterialParameters();

/// The force on the tip of the scene's cell for a modulus of 1 Pa of its outermost layer, solved as `indent`
/// does: at 16 depths to `deepest` (m), the ratios of all moduli held. `live`: by the P1 tetrahedra of a live
/// session. Minutes at the most.
///
/// `free`: one of freeMaterialParameters(), which becomes a parameter of the law, the same in all layers of its
/// model; empty: none. The scene's own value is solved as above, the others on two coarse meshes, and what these say of
/// the force over that of the own value holds for the fine ones: the error of a mesh changes little with the parameter.
/// A value whose solution ends well above the others' is left out; the parameter's bounds are those of the rest.
///
/// Throws ConfigError when the force is not proportional to the modulus, no layer has the parameter, or no depth has a
/// solution.
std::shared_ptr<ElasticLaw> solveSceneLaw(const Scene& scene, bool live, double deepest, const std::string& free = "");

}  // namespace microinjection
