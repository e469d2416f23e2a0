#include "operation/display/surface_quantity.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace microinjection {
namespace {

constexpr Colour kNotKnown{0.42f, 0.42f, 0.44f, 1};
constexpr double kSmallestDisplacement = 1e-6;  // m, above the noise
constexpr double kSmallestStress = 10;          // Pa, above the noise

}  // namespace

const std::vector<std::string>& surfaceQuantities() {
  static const std::vector<std::string> names = {"displacement", "von_mises_stress", "pressure", "contact_pressure"};
  return names;
}

std::optional<SurfaceQuantity> surfaceQuantity(const std::string& name) {
  const auto& names = surfaceQuantities();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<SurfaceQuantity>(found - names.begin());
}

Colour ColourScale::colour(double value) const {
  if (std::isnan(value)) return kNotKnown;
  return isSigned() ? colourOfSignedFraction(value / high) : colourOfFraction(value / high);
}

std::vector<std::string> ColourScale::title() const {
  switch (quantity) {
    case SurfaceQuantity::kDisplacement:
      return {"displacement", "um"};
    case SurfaceQuantity::kVonMisesStress:
      return {"von Mises stress", "kPa"};
    case SurfaceQuantity::kPressure:
      return {"pressure", "kPa"};
    case SurfaceQuantity::kContactPressure:
      return {"contact pressure", "mean, kPa"};
  }
  return {};
}

std::string ColourScale::figure(double value) const {
  const double unit = quantity == SurfaceQuantity::kDisplacement ? 1e-6 : 1e3;
  char text[64];
  std::snprintf(text, sizeof text, "%.3g", value / unit);
  return text;
}

double scaleEnd(SurfaceQuantity quantity, const std::vector<double>& values) {
  double largest = quantity == SurfaceQuantity::kDisplacement ? kSmallestDisplacement : kSmallestStress;
  for (const double value : values) {
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  }
  return niceCeiling(largest);
}

}  // namespace microinjection
