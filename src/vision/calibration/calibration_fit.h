#pragma once

#include <Eigen/Core>
#include <vector>

#include "vision/calibration/calibration_data.h"

namespace microinjection {

/// Least-squares problem of a calibration. Each observation has a flag whether it is used. Residuals are
/// in units of the observations' stated deviations.
class CalibrationFit {
 public:
  CalibrationFit(const CalibrationData& data, const CalibrationStart& start);

  /// Minimizes from the present value; `robust`: with Cauchy's loss. Returns whether it converged.
  bool solve(bool robust);
  /// Flags as outliers what lies beyond 4.5 robust deviations; returns whether a flag changed.
  bool flagOutliers();
  /// Sets the variance factors from the residuals; the next solve() weighs by them.
  void scaleByResiduals();
  /// Covariance of the parameters; false when the observations do not determine them.
  bool covariance(Eigen::Matrix<double, kCalibrationParameters, kCalibrationParameters>& result) const;

  const CalibrationVector<double>& value() const { return value_; }
  const std::vector<bool>& usedPixels() const { return use_pixel_; }  ///< as CalibrationData::pixels
  const std::vector<bool>& usedFocus() const { return use_focus_; }   ///< as CalibrationData::focus
  int freedom() const;       ///< of the used pixels: two for each, less their parameters
  int focusFreedom() const;  ///< of the used focus readings, less theirs
  double varianceFactor() const { return pixel_factor_; }
  double residual() const;       ///< px rms of a coordinate, of the used ones
  double focusResidual() const;  ///< m rms, of the used ones

 private:
  struct Problem;
  Eigen::Vector2d pixelError(std::size_t k) const;  ///< px
  double focusError(std::size_t k) const;           ///< m
  double pixelNorm(std::size_t k) const;            ///< of the whitened residual
  double focusNorm(std::size_t k) const;

  const CalibrationData& data_;
  bool mirrored_;
  CalibrationVector<double> value_;
  std::vector<bool> use_pixel_, use_focus_;
  double pixel_factor_ = 1, focus_factor_ = 1;  ///< variances over the stated ones
};

}  // namespace microinjection
