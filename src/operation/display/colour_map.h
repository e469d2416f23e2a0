#pragma once

#include <Eigen/Core>

namespace microinjection {

/// sRGB with opacity, each in [0, 1].
struct Colour {
  float r = 0;
  float g = 0;
  float b = 0;
  float a = 1;
};

/// Perceptually uniform colour of a fraction in [0, 1] (clamped): blue, green, yellow, of rising
/// lightness. It is the upper three quarters of matplotlib's viridis: the undeformed cell stays
/// visible on a dark background.
Colour colourOfFraction(double fraction);

/// Colour of a fraction in [-1, 1] (clamped), which shows the sign: blue, light grey at 0, red.
/// Interpolated in Moreland's diverging map ("Diverging color maps for scientific visualization",
/// ISVC 2009).
Colour colourOfSignedFraction(double fraction);

/// The readable end of a scale: the smallest of 1, 1.2, 1.6, 2, 2.4, 3.2, 4, 6, 8 times a power of
/// ten that is not below `value` (within 0.1 %, more than rounding). Quarters of these have few
/// digits. 1 for value <= 0.
double niceCeiling(double value);

/// Brightness (about 1) of a surface with this outward unit normal, for a lamp above the left
/// shoulder of a viewer who looks along y. It is never dark, so that colours stay recognisable.
/// rviz does not light triangles with individual colours.
double lampLight(const Eigen::Vector3d& normal);

/// The colour with its brightness multiplied by `light` (>= 0), clamped; the opacity stays.
Colour shaded(const Colour& colour, double light);

}  // namespace microinjection
