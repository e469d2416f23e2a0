#pragma once

#include <Eigen/Core>

#include "cell/family/family_tongue.h"
#include "cell/family/section_family_data.h"

namespace microinjection {

TongueTouch touchOf(const Scene& scene);

/// Logarithm of how much more a tongue rises than that of a half-space of the outermost layer's modulus, roughly, so
/// that little is left to interpolate between members:
///
///     1.4 a^2 - log(c + (1 - c) w),   w = x^2 / (x^2 + 0.4),  x = t / a
///
/// Of bore a, and of two layers: c, modulus of the inside over that of the shell, which is t thick. Both were fitted to
/// solved members. Without the first, a homogeneous member that was left out of 39 was 1.5 % off (rms), with it 1.0 %.
double tongueGrowth(const Scene& member);

/// Follows the member's equilibria from no suction to where they end, on one mesh (level 0 to 1.6 of scene_mesh.h), and
/// takes its TongueCurves. Takes some seconds. @throws std::runtime_error when there are too few equilibria, and as
/// CellProblem does
SectionMember solveTongue(const SectionFamily& family, const Eigen::VectorXd& coordinates);

}  // namespace microinjection
