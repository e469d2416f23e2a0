#pragma once

#include <Eigen/Core>

namespace microinjection {

/// Estimates the properties of a sensor from its readings alone, as in a bench test. A stream holds
/// the readings of one axis (N) at a constant sample rate.

/// Welch's estimate of the one-sided amplitude density (N/sqrt(Hz)), as root mean square over
/// [from, to] (Hz). Averages periodograms of half-overlapping Hann windows without their means.
/// `segment`: samples of a window.
/// @pre 0 < from < to <= sample_rate / 2; the stream has at least one segment.
double noiseDensity(const Eigen::VectorXd& stream, double sample_rate, int segment, double from, double to);

/// Density (N/sqrt(Hz)) of the rounding error of a converter with this step (N): white with
/// variance step^2 / 12, provided that the signal's noise is at least half a step.
double roundingDensity(double step, double sample_rate);

/// Smallest difference between two readings (N); 0 when all are equal.
double quantisationStep(const Eigen::VectorXd& stream);

struct SecondOrder {
  double natural_frequency = 0;  ///< Hz
  double damping_ratio = 0;      ///< 1
};

/// Fits a second-order system to the response to a step of the force. The step occurs at or before
/// the beginning of the stream, and the response has settled at its end. Between samples the
/// deviation from rest follows d_k+1 = a d_k + b d_k-1 exactly. a is the sum and b minus the
/// product of exp(pole x period). Least squares over the part above the noise. The poles must be
/// slower than half the sample rate.
SecondOrder secondOrderOfStep(const Eigen::VectorXd& response, double sample_rate);

struct DriftFigures {
  double rate = 0;         ///< N/s
  double random_walk = 0;  ///< N/sqrt(s)
};

/// Drift from the means of blocks of `block` seconds. Two neighbouring means of a random walk k
/// differ by a variance of 2/3 k^2 T. White noise of the given one-sided density (N/sqrt(Hz)) adds
/// density^2 / T, which is subtracted.
DriftFigures driftOf(const Eigen::VectorXd& block_means, double block, double density);

}  // namespace microinjection
