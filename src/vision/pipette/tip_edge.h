#pragma once

#include <complex>
#include <vector>

namespace microinjection {

/// Image of a straight edge, in focus or out of it: a step from 0 to 1, convolved with a Gaussian of complex variance
/// blur^2 (1 + i fringes). The real part is the image of an absorbing edge. The imaginary part is that of a phase edge,
/// Becke's pair of a dark and a bright line. Both are odd about the edge (but for 1/2), so that neither displaces it.
///
/// Source: J. W. Goodman, Introduction to Fourier Optics, 3rd edition, section 4.2.
class TipEdge {
 public:
  static constexpr double kMostFringes = 2.8;

  /// @param blur     rows, rms
  /// @param fringes  diffraction over squared blur, 0 in focus, at most kMostFringes; rounded to 0.2
  TipEdge(double blur, double fringes);

  /// At `s` rows behind the edge, towards the inside of the tube.
  std::complex<float> at(double s) const;

 private:
  const std::vector<std::complex<float>>* table_;  ///< response less 1/2
  double to_table_;
};

}  // namespace microinjection
