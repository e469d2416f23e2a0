#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/estimation/force_path.h"
#include "cell/estimation/sample_history.h"

namespace microinjection {

/// The smooth part of the residuals in contact: what a model cannot follow.
struct Misfit {
  double found = 0;     ///< over the largest force
  double expected = 0;  ///< same, of noise alone
};

/// From the medians of blocks of the residuals (N, measured minus predicted; `deviations`: their
/// standard deviations, N). `factor`: of the points' forces. Zero with too few samples in contact.
Misfit misfitOf(const std::vector<ForcePath::Point>& points, double factor, const Eigen::VectorXd& residuals,
                const Eigen::VectorXd& deviations);

/// Drift of the sensor (N/s) with its standard deviation, from samples that are `margin` (m) or more above
/// the contact; a rate of 0 with too few of them. `deviations`: of the samples' forces, N.
struct SensorDrift {
  double rate = 0, deviation = 0;
};
SensorDrift driftBeforeContact(const std::vector<SampleHistory::Sample>& samples,
                               const std::vector<ForcePath::Point>& points, double margin,
                               const Eigen::VectorXd& deviations);

}  // namespace microinjection
