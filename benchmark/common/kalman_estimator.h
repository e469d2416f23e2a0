#pragma once

#include <Eigen/Core>
#include <memory>

#include "cell/estimation/cell_estimator.h"
#include "cell/estimation/force_path.h"
#include "cell/estimation/reading_filter.h"

namespace microinjection {

/// The cell estimator by an iterated extended Kalman filter (Bell and Cathey 1993), to be compared with
/// CellEstimator's fit of all samples: same prior, same model, same deviations of the force, same filter
/// of readings. It keeps no history, so that a step costs the same at any depth. It has no weights
/// against outliers, no test of drift or contradiction, and takes the readings' noise from the
/// configuration. Only for elastic cells.
class KalmanEstimator {
 public:
  KalmanEstimator(const Scene& prior, const std::shared_ptr<const SurrogateData>& cell,
                  const CellEstimatorConfig& config);

  /// As CellEstimator::add().
  void add(double time, const Eigen::Vector3d& tip, double force);

  double modulus() const;    ///< Pa
  double deviation() const;  ///< standard deviation of the modulus's logarithm
  /// Whether the interval of 95 %, with the family's median error as CellEstimator has it, contains `other` (Pa).
  bool covers(double other, double law_error) const;

 private:
  double force(const Eigen::Vector3d& tip, const Eigen::Vector3d& state);
  void update(const Eigen::Vector3d& tip, double force, int readings);

  CellEstimatorConfig config_;
  double prior_modulus_;
  ForcePath path_;
  ReadingFilter filter_;
  Eigen::Vector3d state_ = Eigen::Vector3d::Zero();  ///< of ln(modulus / prior), contact (m), offset (N), in deviations
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d tips_ = Eigen::Vector3d::Zero();  ///< m, sum over the readings that wait
  double forces_ = 0;                               ///< N, same
  int waiting_ = 0;
};

}  // namespace microinjection
