#pragma once

#include <vector>

#include "vision/detection/pipette_strip.h"

namespace microinjection {

/// The image of a tube that ends in a blurred step. Of a strip that is folded about the tube's axis,
/// with s = row - end and the column t:
///     grey(s, t) = a + b s + [p0(t) + p1(t) s + p2(t) s^2] step(s / blur) + d face(t) rim(s).
/// The profile p is free in each column; the background a + b s is the same in all columns. In focus the
/// end face has a dark rim that is as wide as the wall. Out of focus the step has fringes instead:
/// odd terms [q1(t) s + q3(t) (s^3 - 3 s)] bell(s), which do not displace the end. For an end, a blur
/// and a width of the rim all else follows by linear least squares.
struct TipModel {
  bool fringes = false;
  int terms() const { return fringes ? 5 : 3; }  ///< that each column has
};

/// The rows and columns of a strip that a model is fitted to, folded about the axis.
class TipWindow {
 public:
  /// Rows [first, last), at most 96, and `columns` from the axis outwards; all in the strip.
  TipWindow(const PipetteStrip& strip, int first, int last, int columns);

  int first() const { return first_; }
  int rows() const { return rows_; }
  int columns() const { return columns_; }
  const float* column(int t) const { return grey_.data() + static_cast<std::ptrdiff_t>(t) * rows_; }
  double weight(int t) const { return t == 0 ? 0.5 : 1; }  ///< the axis is one column, all others are two
  double range() const { return range_; }                  ///< largest less least value
  double square(int t) const { return squares_[t]; }       ///< sum of the squared values of a column

 private:
  int first_, rows_, columns_;
  double range_ = 0;
  std::vector<float> grey_;  ///< column after column, less the mean of all
  std::vector<double> squares_;
};

/// The end face across: 1 within the outline that the rows behind `end` have, blurred.
std::vector<double> endFace(const TipWindow& window, double end, double blur);

/// Sums of the squared residuals of a fit, one for each width of the rim; 0: without a rim.
/// @param blur  rows, rms
/// @param face  endFace() of all columns
/// @param rims  rows; a rim that turns out bright is left out
std::vector<double> tipResiduals(const TipWindow& window, const TipModel& model, double end, double blur,
                                 const std::vector<double>& face, const std::vector<double>& rims);

}  // namespace microinjection
