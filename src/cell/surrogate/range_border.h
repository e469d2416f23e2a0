#pragma once

#include <Eigen/Core>
#include <array>

#include "cell/surrogate/jet.h"
#include "cell/surrogate/surrogate_plan.h"

namespace microinjection {

/// A tip's displacement limited to the surrogate's range. Within the range it is unchanged; outside,
/// and for paths flatter than the prepared ones, it saturates smoothly. An energy of it is smooth
/// everywhere, so that the force fades continuously beyond the range without creating energy.
struct LimitedDisplacement {
  std::array<Jet, 3> coordinates;  ///< m, with derivatives by the displacement
  bool inside = true;              ///< in the range: unchanged
  bool too_deep = false;           ///< deeper than the range

  /// `on_axis`: the contact point is on the cell's axis, where the range is deeper.
  LimitedDisplacement(const SurrogateRange& range, bool on_axis, const Eigen::Vector3d& displacement);

  Eigen::Vector3d value() const;
  /// Turns a function of the coordinates, with derivatives by them, into one of the displacement.
  Jet compose(const Jet& function) const;
};

}  // namespace microinjection
