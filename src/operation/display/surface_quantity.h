#pragma once

#include <optional>
#include <string>
#include <vector>

#include "operation/display/colour_map.h"

namespace microinjection {

/// What the colour of the cell's surface stands for.
enum class SurfaceQuantity { kDisplacement, kVonMisesStress, kPressure, kContactPressure };

/// displacement, von_mises_stress, pressure, contact_pressure, in the order of SurfaceQuantity.
const std::vector<std::string>& surfaceQuantities();
/// Nothing for any other name.
std::optional<SurfaceQuantity> surfaceQuantity(const std::string& name);

/// Colours of the values of a quantity, SI units.
struct ColourScale {
  SurfaceQuantity quantity = SurfaceQuantity::kDisplacement;
  double high = 1;  ///< SI, > 0, at the upper end; the lower one is 0, or -high if isSigned()

  bool isSigned() const { return quantity == SurfaceQuantity::kPressure; }
  double low() const { return isSigned() ? -high : 0; }
  /// Grey for a value that is not known (NaN).
  Colour colour(double value) const;

  std::vector<std::string> title() const;  ///< lines, with the unit of figure()
  std::string figure(double value) const;  ///< a value in the legend's unit, um or kPa
};

/// End of the scale that shows these values (NaN: not known), a readable figure above the noise.
double scaleEnd(SurfaceQuantity quantity, const std::vector<double>& values);

}  // namespace microinjection
