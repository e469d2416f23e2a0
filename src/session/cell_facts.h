#pragma once

#include <string>

namespace microinjection {

/// What a session has to know of its scene to fit its parameters to the cell.
struct CellFacts {
  static constexpr double kRadius = 28e-6, kModulus = 17.9e3;  ///< m, Pa, of the cell that the files of config are for

  double radius = kRadius;    ///< m, > 0
  double modulus = kModulus;  ///< Pa, > 0, Young's, as the needle feels it: of layers an estimate
  double puncture_force = 0;  ///< N, the largest of all membranes; 0: unknown
  double tip_radius = 0;      ///< m, > 0, of the needle
  double mouth_radius = 0;    ///< m, of the holding pipette; 0: unknown

  double lengthScale() const { return radius / kRadius; }
  double forceScale() const { return modulus / kModulus * lengthScale() * lengthScale(); }

  /// Throws ConfigError when the scene has no valid cell and needle.
  static CellFacts ofScene(const std::string& path);
};

}  // namespace microinjection
