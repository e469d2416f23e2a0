#pragma once

#include <memory>
#include <vector>

#include "cell/model/scene.h"

namespace microinjection {

/// The tongue that a suction draws from an intact cell into the bore of its needle, in equilibrium, without dimension:
/// over the bore's radius a and the modulus E of what is drawn in. A bore is small against its cell, so it sees a half
/// space, and the dent that the needle has made is left out.
///
/// Monotone cubic interpolation (Fritsch and Carlson) through solved points. Beyond the strongest of them there is no
/// equilibrium: the tongue is drawn in without end.
class BoreTongue {
 public:
  struct Point {
    double suction = 0;  ///< over E
    double length = 0;   ///< over a, of the tongue beyond what reaches into the mouth without suction
    double volume = 0;   ///< over a^3, the same
  };

  /// Throws std::invalid_argument unless there are four points or more, the first is zero, and all rise.
  explicit BoreTongue(const std::vector<Point>& points);

  double strongest() const { return strongest_; }
  double length(double suction) const;  ///< over a; @pre suction >= 0; constant beyond strongest()
  double volume(double suction) const;  ///< over a^3, same

 private:
  struct Curves;
  double strongest_;
  std::shared_ptr<const Curves> curves_;
};

/// What the scene's needle draws in, as a cell of its own: a sphere of the innermost layer, in a mouth that is the
/// needle's bore. @throws ConfigError when the scene's needle has no bore
Scene boreMouth(const Scene& scene);

/// Solves the tongue of boreMouth(): some seconds. Suctions rise in steps of a twentieth of the
/// modulus as long as there is an equilibrium.
/// @throws ConfigError when the scene's needle has no bore, or fewer than four suctions have an equilibrium
BoreTongue solveBoreTongue(const Scene& scene);

}  // namespace microinjection
