#pragma once

#include <vector>

#include "cell/model/scene.h"

namespace microinjection {

/// What a shaft that widens adds to the force of a needle in its hole: z behind the tip it has the radius
///
///     r(z) = R + z tan(taper)
///
/// and the wall of a hole of undeformed radius b, which is opened to it, stores E(b, r) for each metre of shaft
/// (HoleExpansion). With the shaft in the hole to z the force is that of the wall at its mouth over the tip's,
///
///     E(b, r(z)) - E(b, R),
///
/// a function of the depth alone, hence conservative. Of the dent in which the hole was made nothing is opened.
class ShaftTaper {
 public:
  /// @param hole m, its undeformed radius, below the tip's
  /// @param dent m, depth of the tip in the whole cell less the length of its first hole
  /// @pre scene.needle.tip.taper > 0, and the cell is homogeneous
  /// Throws ConfigError where the shaft gets so wide that the material cannot be stretched around it.
  ShaftTaper(const Scene& scene, double hole, double dent);

  double force(double depth) const;  ///< N, out of the cell; O(1)

 private:
  double dent_, step_;          ///< m
  std::vector<double> forces_;  ///< N, at equal steps of the shaft's length in the hole; beyond, its last slope
};

}  // namespace microinjection
