#pragma once

#include <optional>
#include <vector>

#include "vision/border/cell_border.h"
#include "vision/frame/contrast_mode.h"
#include "vision/frame/ellipse.h"
#include "vision/frame/frame.h"

namespace microinjection {

constexpr int kSearchRays = 96, kSearchColumns = 110;
constexpr double kSearchSmoothing = 1.2;   // columns
constexpr double kBorderGap = 1.03;        // ratio of two borders' radii, at least
constexpr double kBorderSignificance = 3;  // of a second border
constexpr double kOutwards = 0.2;          // see BorderBand
constexpr int kFreeChange = 4;             // columns from ray to ray, of a border about another centre

double radiusOf(const CellBorder& border);  ///< px
/// px, that a border may be off its ellipse.
double toleranceFor(double radius);
/// Scale of the map's slopes, and at least what noise makes of them.
double scaleOf(const Frame& frame, const PolarMap& map);
/// The map about an ellipse between two ratios to its radius.
PolarMap mapAbout(const Frame& frame, const Ellipse& base, double low, double high);

/// The clearest border in a map, of the polarities that the contrast mode has.
/// @param radius  px, of the base
CellBorder bestBorder(const Frame& frame, const PolarMap& map, ContrastMode mode, double radius,
                      const BorderBand& band = {});
/// The clearest border between two ratios to the main one's radius.
CellBorder searchBand(const Frame& frame, const CellBorder& main, double low, double high, ContrastMode mode,
                      double outwards = 0);
/// Whether a border beside the main one is as clear as one must be.
bool isSecondBorder(const CellBorder& border);
/// Whether a faint ring is there at all.
bool isRing(const CellBorder& border);

/// A border that noise hides in each direction alone, where all directions together show a dark ring about `inner`. In
/// DIC there is none: its two sides cancel.
/// @param least  ratio to the radius of `inner`
/// @param limit  px, largest radius
CellBorder faintBorder(const Frame& frame, const CellBorder& inner, double least, double limit, ContrastMode mode);
/// Borders that are farther out, up to `limit` (ratio to the main one's radius): the last is the zona's outer border,
/// one before it the inner.
std::vector<CellBorder> bordersOutside(const Frame& frame, const CellBorder& main, double limit, ContrastMode mode);

/// Radius over that of `base` of the clearest dark ring about it, between the ratios `low` and `high`; nothing without
/// one. All directions together show a line that noise hides in each of them. Sectors with a pipette or a neighbour do
/// not count, as long as they are less than half of all.
std::optional<double> findFaintRing(const Frame& frame, const Ellipse& base, double low, double high);

}  // namespace microinjection
