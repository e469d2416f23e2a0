#pragma once

#include <Eigen/Core>

namespace microinjection {

/// What a sensor is like, found from nothing but its stream of readings, as one would on a bench. A stream holds the
/// readings of one axis (N), each taken a sample period after the one before.

/// Welch's estimate of the one-sided amplitude density (N/sqrt(Hz)), the root mean square over [from, to] (Hz):
/// periodograms under a Hann window that overlap by half, each without its mean. `segment` samples in each.
/// @pre 0 < from < to <= sample_rate / 2, at least one segment in the stream
double noiseDensity(const Eigen::VectorXd& stream, double sample_rate, int segment, double from, double to);

/// Density of the rounding error of a converter with this step (N): white, of variance step^2 / 12, as long as noise of
/// half a step or more goes over it.
double roundingDensity(double step, double sample_rate);

/// Smallest difference between two readings (N); 0 when all are equal.
double quantisationStep(const Eigen::VectorXd& stream);

struct SecondOrder {
  double natural_frequency = 0;  ///< Hz
  double damping_ratio = 0;      ///< 1
};

/// From the response to a step of the force at or before the stream's begin, that has come to rest at its end. Between
/// samples the deviation from rest follows d_k+1 = a d_k + b d_k-1 exactly, and a and b are the sum and minus the
/// product of exp(pole x period). The poles must be slower than half the sample rate. Least squares over what stands
/// out.
SecondOrder secondOrderOfStep(const Eigen::VectorXd& response, double sample_rate);

struct Drift {
  double rate = 0;         ///< N/s
  double random_walk = 0;  ///< N/sqrt(s)
};

/// From the means of blocks of `block` seconds. Two neighbours of a random walk k differ by a variance of 2/3 k^2 T;
/// white noise of the given one-sided density (N/sqrt(Hz)) adds density^2 / T, which is taken off.
Drift driftOf(const Eigen::VectorXd& block_means, double block, double density);

}  // namespace microinjection
