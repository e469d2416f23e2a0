#pragma once

#include <Eigen/Core>
#include <vector>

namespace microinjection {

/// Coordinates of the next members to solve, the most useful first: each is where the prediction
/// from the known ones and those before it is most uncertain (the greedy choice by the power
/// function, De Marchi, Schaback, Wendland, Adv. Comput. Math. 23 (2005) 317). All are multiples of
/// 1/4, so that they are exact as text.
///
/// @param known a column each, of members that are solved or have failed
/// @param lengths see Kriging
std::vector<Eigen::VectorXd> nextMembers(const Eigen::MatrixXd& known, const Eigen::VectorXd& lengths, int count);

}  // namespace microinjection
