#pragma once

#include <Eigen/Core>

#include "cell/family/family_tongue.h"
#include "cell/family/mouth_family_data.h"

namespace microinjection {

TongueTouch touchOf(const Scene& scene);

/// Follows the member's equilibria from no suction to where they end, on one mesh (level 0 to 1.6 of scene_mesh.h), and
/// takes its TongueCurves. Takes some seconds. @throws std::runtime_error when there are too few equilibria, and as
/// CellProblem does
MouthMember solveTongue(const MouthFamily& family, const Eigen::VectorXd& coordinates);

}  // namespace microinjection
