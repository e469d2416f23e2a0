#pragma once

#include <vector>

#include "cell/model/pierced_branch.h"

namespace microinjection {

/// A branch in closed form: the whole cell is a spring k; a hole costs e for each metre to be opened, and its bottom is
/// that spring: Pi = e d + k/2 max(d - l, 0)^2.
struct SpringBranch {
  double opened = 0.5e-6, spring = 0.1, cost = 0.8e-6, barrier = 0, wall_force = 0;  // N, N/m, N, J, N/m

  std::vector<PiercedBranch::Knot> path(double length) const {
    std::vector<PiercedBranch::Knot> knots;
    const double held = length == 0 ? 0 : opened;
    for (int i = length == 0 ? 0 : -8; i <= 40; ++i) {
      const double beyond = 1e-6 * i, dent = i > 0 ? beyond : 0;
      knots.push_back({beyond, held + spring * dent, held * (length + beyond) + 0.5 * spring * dent * dent});
    }
    return knots;
  }
  /// @param inner N, cost of the cell's next layer, which begins at a hole's length of `border`, m; 0: there is none
  PiercedBranch make(double border = 0, double inner = 0) const {
    std::vector<PiercedBranch::Hole> holes;
    for (const double length : {1e-6, 3e-6, 7e-6, 15e-6, 30e-6}) holes.push_back({length, path(length)});
    PiercedBranch::Crack crack{{{0, cost}}, barrier, wall_force};
    if (border > 0) crack.parts.push_back({border, inner});
    return PiercedBranch(path(0), holes, crack);
  }
};

}  // namespace microinjection
