#pragma once

namespace microinjection {

/// Offset and noise of a force at rest, from its first samples (Welford's sums).
class ForceNoise {
 public:
  /// `samples` (> 1) to take; `floor` (N, > 0): smallest deviation, for a force without noise.
  ForceNoise(int samples, double floor) : wanted_(samples), floor_(floor) {}

  void add(double force);  ///< N; adds a sample at rest, ignored when ready()
  bool ready() const { return count_ >= wanted_; }

  double offset() const { return mean_; }  ///< N
  /// N, standard deviation, increased by two of its own standard errors to be on the safe side.
  double deviation() const;

 private:
  int wanted_;
  double floor_;  ///< N
  int count_ = 0;
  double mean_ = 0;     ///< N
  double squares_ = 0;  ///< N^2, of the deviations from the mean
};

/// The number of standard deviations that a normal deviate exceeds with a probability in (0, 0.5).
double normalQuantile(double probability);

}  // namespace microinjection
