#pragma once

#include <vector>

#include "vision/pipette/pipette_strip.h"
#include "vision/pipette/tip_outline.h"

namespace microinjection {

/// The image of a tube that ends in a straight edge. Of a strip that is folded about the tube's axis, with
/// s = row - end and the column t:
///     grey(s, t) = a + b s + [p0(t) + p1(t) s + p2(t) s^2] Re edge(s) + q(t) Im edge(s) + d face(t) rim(s).
/// The profile p and the pair of lines q are free in each column; the background a + b s is the same in all columns.
/// q is 0 in focus. The end face has a dark rim that is as wide as the wall. For an end, a blur, fringes and a width of
/// the rim all else follows by linear least squares. A cubic profile would make the end less certain. See tip_edge.h.
struct TipModel {
  double blur = 1;     ///< rows, rms
  double fringes = 0;  ///< see TipEdge; 0: in focus
};

/// A factor of each column, of a term that all columns share, and the sum of a window's columns with these factors.
struct SharedColumns {
  std::vector<double> factor;
  std::vector<float> sum;  ///< a value a row; 0 behind the last row
};

/// The rows and columns of a strip that a model is fitted to, folded about the axis.
class TipWindow {
 public:
  static constexpr int kMostRows = 96;
  /// Rows [first, last), at most kMostRows, and `columns` from the axis outwards; all in the strip.
  /// The columns widen with the outline behind the end, so that a wall stays in its column.
  TipWindow(const PipetteStrip& strip, int first, int last, int columns, const TipOutline& outline, double end);

  int first() const { return first_; }
  int rows() const { return rows_; }
  int columns() const { return columns_; }
  const float* column(int t) const { return grey_.data() + static_cast<std::ptrdiff_t>(t) * kMostRows; }
  double weight(int t) const { return t == 0 ? 0.5 : 1; }  ///< the axis is one column, all others are two
  double range() const { return range_; }                  ///< largest less least value
  double square(int t) const { return squares_[t]; }       ///< sum of the squared values of a column
  const SharedColumns& all() const { return all_; }        ///< each with the factor 1
  SharedColumns sharedBy(std::vector<double> factor) const;

 private:
  int first_, rows_, columns_;
  double range_ = 0;
  std::vector<float> grey_;  ///< column after column, less the mean of all; 0 behind the last row
  std::vector<double> squares_;
  SharedColumns all_;
};

/// The end face across: 1 within the outline that the rows behind `end` have, blurred.
struct EndFace {
  SharedColumns whole, narrower;  ///< the second of a tube that is a little narrower
  /// rows, of a rim: half of the radius less its blur. The wall of a pulled pipette is at most half of its radius, as
  /// that of the capillary was. A wider and fainter rim would describe a thin tube as well, with an end farther out.
  double widest_rim = 0;

  EndFace(const TipWindow& window, double end, double blur);
};

/// Number of terms that each column has.
int termsOf(const TipModel& model);

/// Sums of the squared residuals of a fit, one for each width of the rim; 0: without a rim.
/// @param rims  rows; a rim that turns out bright is left out
std::vector<double> tipResiduals(const TipWindow& window, const TipModel& model, double end, const EndFace& face,
                                 const std::vector<double>& rims);

}  // namespace microinjection
