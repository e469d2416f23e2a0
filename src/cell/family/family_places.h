#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/surrogate/surrogate_plan.h"

namespace microinjection {

/// The range of a member. Its proportions are those of all members, so that they have the same
/// paths in units of the range. `angle`: rad, `depth`: m.
SurrogateRange familyRange(double angle, double depth);

/// A contact of the tip.
struct ContactPlace {
  double angle = 0;                                        ///< rad, of the contact point
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< m, of the tip, in the contact frame
  double share = 1;                                        ///< of the length of its path
};

/// The places at which all members of a family store their surface: along every path of the range,
/// below it on the axis, and the cell at rest. In units of the range they are the same for every
/// member.
std::vector<ContactPlace> surfacePlaces(const SurrogateRange& range);

/// contactVariables of surfacePlaces, a column each.
Eigen::MatrixXd surfaceCentres();

/// The places at which two members' forces are compared: a few along each path that a member's cell
/// is touched on.
std::vector<ContactPlace> forcePlaces(const SurrogatePlan& plan);

}  // namespace microinjection
