#pragma once

#include <Eigen/Core>

#include "cell/family/family_tongue.h"
#include "cell/family/tongue_family.h"

namespace microinjection {

/// A member of a tongue family that was solved.
struct TongueMember {
  Eigen::VectorXd coordinates;
  TongueCurves curves;
};

TongueTouch touchOf(const Scene& scene);

/// Follows the member's equilibria from no suction to where they end, on one mesh (level 1 of scene_mesh.h), and takes
/// its curves at tongueFractions() of what is served. Takes some ten seconds. @throws std::runtime_error when there are
/// too few equilibria, and as CellProblem does
TongueMember solveTongue(const TongueFamily& family, const Eigen::VectorXd& coordinates);

}  // namespace microinjection
