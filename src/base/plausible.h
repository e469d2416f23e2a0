#pragma once

#include <string>

#include "base/config_errors.h"
#include "base/range.h"

namespace microinjection {

/// A physical quantity and the values that can be meant: one beyond them is a slip, mostly of the unit.
struct PlausibleRange {
  const char* unit;  ///< SI; "" of a ratio
  Range range;

  /// What is allowed, and the unit that brings `value` into the range: "1e-6 .. 5e-3 m; 56 um would be 56e-6".
  std::string allowed(double value) const;
  /// Adds "KEY = VALUE UNIT: must be ALLOWED" unless the value is in the range.
  void require(const std::string& key, double value, ConfigErrors& errors) const;
};

/// The slip of the unit by which a value is too large by `factor`: "mN for N?"; empty: by none that is usual.
std::string unitSlip(double factor, const std::string& unit);

/// Quantities of a scene and of the commands' options. They are wide: a range has to hold every cell and tip that there
/// is, and to leave out the same number in another unit.
namespace plausible {

inline constexpr PlausibleRange kCellDiameter{"m", {1e-6, 5e-3}};
inline constexpr PlausibleRange kCellRadius{"m", {0.5e-6, 2.5e-3}};
inline constexpr PlausibleRange kCellModulus{"Pa", {1, 1e9}};  ///< envelopes: 60 MPa
inline constexpr PlausibleRange kFilamentModulus{"Pa", {1e3, 1e12}};
inline constexpr PlausibleRange kBendingStiffness{"N m^2", {1e-30, 1e-15}};
inline constexpr PlausibleRange kTipRadius{"m", {1e-8, 1e-3}};
inline constexpr PlausibleRange kConeAngle{"rad", {0, 1.5707963267948966, true, true}};  ///< half of its opening
inline constexpr PlausibleRange kDepth{"m", {1e-9, 5e-3}};                               ///< of an indentation
inline constexpr PlausibleRange kLength{"m", {1e-9, 2.5e-3}};   ///< of a part of the cell: a membrane, a mesh's element
inline constexpr PlausibleRange kDistance{"m", {-5e-3, 5e-3}};  ///< along any direction; also 0
inline constexpr PlausibleRange kAdhesionRange{"m", {1e-10, 1e-3}};
inline constexpr PlausibleRange kPixelSize{"m", {1e-9, 1e-4}};  ///< of the specimen
inline constexpr PlausibleRange kForce{"N", {1e-13, 1}};
inline constexpr PlausibleRange kFriction{"N", {0, 1}};          ///< of the needle's shaft
inline constexpr PlausibleRange kTension{"N/m", {0, 1}};         ///< of a surface; water: 0.072
inline constexpr PlausibleRange kStiffness{"N/m", {1e-6, 1e4}};  ///< of a spring, a lever, a layer
inline constexpr PlausibleRange kAdhesionEnergy{"J/m^2", {0, 1}};
inline constexpr PlausibleRange kToughness{"J/m^2", {1e-6, 1e6}};
inline constexpr PlausibleRange kWork{"J", {0, 1e-3}};  ///< of a needle on a cell
inline constexpr PlausibleRange kFrictionCoefficient{"", {0, 10}};
inline constexpr PlausibleRange kViscosity{"Pa s", {0, 1e6}};
inline constexpr PlausibleRange kRelaxationTime{"s", {1e-6, 1e6}};
inline constexpr PlausibleRange kTime{"s", {0, 1e6}};
inline constexpr PlausibleRange kSpeed{"m/s", {1e-10, 1}};
inline constexpr PlausibleRange kSuction{"Pa", {-101325, 0}};  ///< gauge: from a vacuum to none
inline constexpr PlausibleRange kStrain{"", {1e-4, 10}};

}  // namespace plausible

}  // namespace microinjection
