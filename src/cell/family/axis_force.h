#pragma once

#include <Eigen/Core>
#include <functional>

#include "cell/family/chebyshev_grid.h"
#include "cell/family/family.h"
#include "cell/surrogate/surrogate_data.h"

namespace microinjection {

/// The force on the axis of a member, over the force of EnergyScales, as a function of s, the root
/// of the depth over the range's axis depth. It has the largest part of what varies in a family. The
/// section has it in seconds, and so it is known on a dense grid of members.
using AxisCurve = std::function<double(double)>;

/// Number of depths at which a curve is solved for: at equal steps of s, to 1.
constexpr int kAxisDepths = 12;

ChebyshevGrid axisForceGrid(const Family& family);

/// Forces of the section at the depths of a curve. Beyond the deepest equilibrium they grow on as
/// before it.
/// @throws std::runtime_error when the section does not reach half of the range's depth, and as
/// CellProblem does
Eigen::VectorXd solveAxisForces(const Family& family, const Eigen::VectorXd& coordinates);

/// Curve through the logarithms of the forces at its depths.
AxisCurve axisCurve(const Eigen::VectorXd& log_forces);

/// The curve of a force field with these scales.
AxisCurve axisCurve(const ForceField& field, const EnergyScales& scales);

/// Ratio of two curves, constant below the first depth and beyond the share `axis_share` of the
/// range's axis depth, which is known of both.
AxisCurve axisRatio(const AxisCurve& curve, const AxisCurve& other, double axis_share);

/// Size of a member's force: that on the axis at half of the range's depth, over the force of
/// EnergyScales.
double axisForce(const ForceField& field, const SurrogatePlan& plan);

}  // namespace microinjection
