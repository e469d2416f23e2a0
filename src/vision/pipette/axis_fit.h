#pragma once

#include "vision/pipette/pipette_strip.h"

namespace microinjection {

/// What shows a pipette's axis: the strip behind its end.
constexpr int kAxisRows = 160;      ///< px behind the end, whose symmetry gives the axis
constexpr double kAxisMargin = 24;  ///< px beside an outline, that shows the symmetry
constexpr double kAxisBlur = 1.5;   ///< px, of the derivative across the axis
constexpr int kAxisShift = 8;       ///< columns, that the axis may be off

/// A straight axis in a strip, by the symmetry of its rows.
struct AxisFit {
  bool valid = false;
  double symmetry = 0;          ///< 0..1, mean over the rows
  double offset = 0;            ///< columns from the middle, at the first row
  double slant = 0;             ///< columns per row
  double offset_deviation = 0;  ///< columns
  double slant_deviation = 0;   ///< columns per row
};

/// Fits the axis to `rows` rows from row `first`. All rows together choose the axis; the places where
/// blocks of them are most symmetric beside it refine it.
/// @param half_width  columns on both sides that are compared
/// @param most        columns that the axis may be off
AxisFit fitAxis(const PipetteStrip& strip, int first, int rows, double half_width, int most);

}  // namespace microinjection
