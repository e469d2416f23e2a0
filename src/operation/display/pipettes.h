#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/config_reader.h"
#include "operation/display/display_scale.h"
#include "operation/display/triangle_soup.h"

namespace microinjection {

/// The drawn injection pipette: a tapered glass tube whose bore and wall keep their ratio, as in
/// pulled glass. The default sizes are those of a typical ICSI needle with a bore of 4 um.
struct DrawnInjectionPipette {
  double tip_radius = 3e-6;     ///< m, outer
  double bore_ratio = 0.7;      ///< 1, inner over outer radius
  double taper_angle = 0.07;    ///< rad, of the outer wall with the axis
  double shaft_radius = 10e-6;  ///< m, outer, at the end of the taper
  double length = 120e-6;       ///< m, of the drawn part

  static DrawnInjectionPipette read(ConfigReader& reader);
};

/// The drawn holding pipette: a blunt glass tube whose mouth was fire-polished to a small hole.
struct DrawnHoldingPipette {
  double mouth_radius = 10e-6;  ///< m, of the hole, where the cell touches it
  double outer_radius = 30e-6;  ///< m
  double bore_ratio = 0.7;      ///< 1, inner over outer radius behind the mouth
  double length = 55e-6;        ///< m, of the drawn part

  static DrawnHoldingPipette read(ConfigReader& reader);
};

/// The shaded, translucent glass in the pipette's own frame, display units: origin at the centre of
/// the tip or mouth, z into the body.
TriangleSoup glass(const DrawnInjectionPipette& pipette, double enlargement = kDisplayScale);
TriangleSoup glass(const DrawnHoldingPipette& pipette, double enlargement = kDisplayScale);

/// The circle of contact between the cell and the holding pipette.
struct Mouth {
  double radius = 0;  ///< m, about the pipette's axis
  double height = 0;  ///< m, along the pipette's z axis; negative: the cell bulges into the mouth
};

/// The circle through the outermost held point.
/// @param held  m, in the pipette's frame; not empty.
Mouth fitMouth(const std::vector<Eigen::Vector3d>& held);

}  // namespace microinjection
