#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "cell/model/scene.h"
#include "cell/surrogate/training_ray.h"

namespace microinjection {

template <int Dim>
class CellProblem;

/// Displacement (m; away from the axis, along it) of a section's outer surface as a function of the angle (rad) of its
/// points from the upper pole at rest.
using SectionOutline = std::map<double, Eigen::Vector2d>;

/// Of the section's present state.
SectionOutline sectionOutline(const CellProblem<2>& problem);

/// Linear between the outline's points. @pre `angle` is from 0 to pi
Eigen::Vector2d displacementAt(const SectionOutline& outline, double angle);

/// Converged equilibria of the cell's section for a tip that moves down on the axis to `depths` (m,
/// ascending). They go deeper than in space, where the cell can buckle sideways. Each depth has the
/// result of the finest mesh that reaches it; depths that no mesh reaches are left out.
std::vector<TrainingSample> solveAxis(const Scene& scene, const std::vector<double>& depths);

}  // namespace microinjection
