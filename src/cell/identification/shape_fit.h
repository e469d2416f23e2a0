#pragma once

#include <Eigen/Core>
#include <limits>

#include "cell/identification/axis_shape.h"

namespace microinjection {

/// Samples of a needle on the cell's axis.
struct AxisSamples {
  Eigen::VectorXd time;       ///< s
  Eigen::VectorXd travel;     ///< m, grows into the cell; its zero is arbitrary
  Eigen::VectorXd force;      ///< N, grows with the depth
  Eigen::VectorXd deviation;  ///< N, standard deviation of each force
};

/// What is known before a fit; an infinite deviation: nothing.
struct ShapeFitConfig {
  double contact = 0;                                                  ///< m, of travel
  double contact_deviation = std::numeric_limits<double>::infinity();  ///< m
  double offset_deviation = std::numeric_limits<double>::infinity();   ///< N, about 0
  bool drift = false;                                                  ///< linear in time, of the sensor
};

/// modulus shape(travel - contact) + offset + drift (time - time of the first sample)
struct ShapeFit {
  double modulus = 0;                                       ///< Pa
  double contact = 0;                                       ///< m
  double offset = 0;                                        ///< N
  double drift = 0;                                         ///< N/s
  double square = std::numeric_limits<double>::infinity();  ///< robust sum of squares over the deviations
};

/// Gauss-Newton steps from `start` with Cauchy's weights and Levenberg's damping. Forces are linear in
/// all but the contact, so that a start a micrometre off is near enough.
ShapeFit fitShape(const AxisShape& shape, const AxisSamples& samples, const ShapeFitConfig& config,
                  const ShapeFit& start, int steps);

/// N, of each sample.
Eigen::VectorXd forcesOf(const AxisShape& shape, const AxisSamples& samples, const ShapeFit& fit);

}  // namespace microinjection
