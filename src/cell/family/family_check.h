#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/family/family_data.h"

namespace microinjection {

/// Coordinates of members at random, for a check of the interpolation between the solved ones.
std::vector<Eigen::VectorXd> drawMembers(const Family& family, int count, int seed);

/// Converged paths to random places in a member's planned range, up to 56 degrees, 0.3 diameters deep and
/// 0.08 diameters sideways; two places on each. One of five is out of the plane of symmetry. Each path
/// is there twice, for its force on the fine mesh and for its surface on the coarse one.
Preparation drawMotions(const Family& family, const Eigen::VectorXd& coordinates, int seed);

/// A place where a family's cell is compared with the converged solution.
struct CheckedPlace {
  double angle = 0;          ///< rad
  double depth = 0;          ///< over the diameter
  double lateral = 0;        ///< over the diameter
  double force_share = 0;    ///< of the member's largest force
  double force_error = 0;    ///< relative
  double surface_error = 0;  ///< rms over the nodes of SurfaceGrid, over the diameter
};

/// Compares the family's member with the results of drawMotions, at places within its range.
std::vector<CheckedPlace> compareMember(const FamilyData& data, const Eigen::VectorXd& coordinates,
                                        const Preparation& motions, const std::vector<TrainingResult>& results);

}  // namespace microinjection
