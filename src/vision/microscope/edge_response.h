#pragma once

#include <complex>
#include <vector>

namespace microinjection {

/// Image of a straight edge: a step from 0 to 1, convolved with a Gaussian of complex variance.
///
/// The real part of the variance is the blur of the objective and of the defocus. The imaginary
/// part, lambda z / (2 pi) at a distance z behind the object, is Fresnel's diffraction: its kernel
/// is a Gaussian of imaginary variance. So the real part of the response is the image of an
/// absorbing edge, with its fringes, and the imaginary part that of a weak phase edge: a pair of a
/// dark and a bright line which changes sign with z (Becke's line). Both are exactly odd about the
/// edge, so that no blur displaces it.
///
/// Source: J. W. Goodman, Introduction to Fourier Optics, 3rd edition, section 4.2.
class EdgeResponse {
 public:
  using Value = std::complex<float>;

  /// The responses of one variance.
  class Depth {
   public:
    /// Of a pixel at distance `u` from the edge, positive where the step is 1; the unit's square is
    /// that of the variance.
    Value at(float u) const {
      const float v = std::abs(u) * to_table_;
      if (v >= last_) return Value(u > 0 ? 1 : 0, 0);
      const int i = static_cast<int>(v);
      const float t = v - static_cast<float>(i);
      const Value low = near_[i] + t * (near_[i + 1] - near_[i]);
      const Value high = far_[i] + t * (far_[i + 1] - far_[i]);
      Value rise = low + share_ * (high - low);
      rise = Value(rise.real(), sign_ * rise.imag());
      return u >= 0 ? Value(0.5F, 0) + rise : Value(0.5F, 0) - rise;
    }
    /// Distance beyond which at() is 0 or 1.
    double reach() const { return last_ / to_table_; }

   private:
    friend class EdgeResponse;
    const Value* near_ = nullptr;  ///< rows of the table on both sides of the variance's argument
    const Value* far_ = nullptr;
    float share_ = 0;  ///< of the row far_
    float sign_ = 1;   ///< of the imaginary part
    float to_table_ = 0;
    float last_ = 0;
  };

  EdgeResponse();

  /// `blur`: real part of the variance, above 0; `diffraction`: imaginary part. A ratio of more than
  /// about 10, which only a nearly coherent source has, is cut there by raising the blur.
  Depth depth(double blur, double diffraction) const;

 private:
  /// Response less 1/2 over |u| / sqrt|variance|, a row an argument; the table of all objects.
  const std::vector<std::vector<Value>>& rows_;
};

}  // namespace microinjection
