#pragma once

#include <Eigen/Core>

#include "cell/family/chebyshev_grid.h"
#include "cell/family/family.h"
#include "cell/surrogate/surrogate_data.h"

namespace microinjection {

/// The size of a member's force: that on the axis at half of the range's depth, over the force of
/// EnergyScales. Solved in the section it takes a second, and so is known on a dense grid.
ChebyshevGrid axisForceGrid(const Family& family);

/// @throws std::runtime_error when the section has no solution there, and as CellProblem does
double solveAxisForce(const Family& family, const Eigen::VectorXd& coordinates);

/// The same of a fitted member with this plan.
double axisForce(const ForceField& field, const Preparation& plan);

}  // namespace microinjection
