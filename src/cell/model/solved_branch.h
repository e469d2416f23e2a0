#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cell/model/pierced_branch.h"
#include "cell/model/scene.h"
#include "cell/penetration/deep_penetration.h"

namespace microinjection {

/// The scene's cell is pierced by mechanics: the toughness of its outermost layer is given, not the force at which it
/// fails, and maybe that of those behind it.
bool piercedByMechanics(const Scene& scene);

/// What a long hole through the scene's cell costs. @pre piercedByMechanics(scene)
SteadyPenetration steadyPenetration(const Scene& scene);

/// Solves the scene's cell whole and with holes of several lengths (PiercedCell); half a minute on one core, minutes of
/// a material that stiffens. The hole has the radius that is best for steady penetration. `level`: of the meshes.
/// `report` is called before each of the paths with their number and count.
/// @throws ConfigError for a scene that cannot be pierced by mechanics, and says why
PiercedBranch solvePiercedBranch(const Scene& scene, double level = 0,
                                 const std::function<void(int, int)>& report = {});

/// The same from the user's cache, or solved and stored there.
PiercedBranch storedPiercedBranch(const Scene& scene, const std::function<void(int, int)>& report = {});

/// Pi0(d) and Pi(d, l) of PiercedBranch, without what the crack costs.
struct PiercedPaths {
  std::vector<PiercedBranch::Knot> whole;
  std::vector<PiercedBranch::Hole> holes;
  double gives_way = 0;  ///< m, depth at which the strength of the outermost layer is exceeded; 0: it has none
};

/// With the toughness, barrier and wall of the scene. @throws ConfigError as solvePiercedBranch()
PiercedBranch branchOf(PiercedPaths paths, const Scene& scene);

/// Relative difference of the branch's force 3 tip radii behind the onset from that of the long hole in the material
/// there, which is exact far behind the surface. None where nothing pierces it.
std::optional<double> distanceFromLongHole(const PiercedBranch& branch, const Scene& scene);

/// For the user: where it is pierced, and the force 3 tip radii further on, with that difference.
std::string describePuncture(const PiercedBranch& branch, const Scene& scene);

}  // namespace microinjection
