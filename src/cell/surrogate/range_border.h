#pragma once

#include <Eigen/Core>
#include <array>

#include "cell/surrogate/jet.h"
#include "cell/surrogate/preparation.h"

namespace microinjection {

/// A tip's displacement as it counts for a prepared cell: itself in the prepared range; further out, and where it is
/// flatter than what was prepared or rises, it saturates smoothly. An energy of this is smooth everywhere, so that
/// beyond the range the force fades, continuously, and still creates no energy.
struct CountedDisplacement {
  std::array<Jet, 3> coordinates;  ///< m, with derivatives by the displacement
  bool inside = true;              ///< in the range: nothing was changed
  bool too_deep = false;           ///< deeper than the range

  /// `on_axis`: the tip touched on the cell's axis, where the range is deeper.
  CountedDisplacement(const PreparationRange& range, bool on_axis, const Eigen::Vector3d& displacement);

  Eigen::Vector3d value() const;
  /// A function of the coordinates, with derivatives by them, as a function of the displacement.
  Jet compose(const Jet& function) const;
};

}  // namespace microinjection
