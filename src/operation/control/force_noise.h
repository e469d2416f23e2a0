#pragma once

#include <cstddef>
#include <vector>

namespace microinjection {

/// Offset and noise of a force at rest, from its first samples. A force that rises meanwhile, because
/// the needle is moved into the cell, ends the measurement, and the samples before the rise count: the
/// first 20 at the least. The rise is found by Page's cumulative sum, see ContactDetector.
class ForceNoise {
 public:
  /// `samples` (> 1) to take; `floor` (N, > 0): smallest deviation, for a force without noise;
  /// `change` (N, > 0): a rise to find.
  ForceNoise(int samples, double floor, double change);

  void add(double force);  ///< N; adds a sample at rest, ignored when ready()
  bool ready() const { return ready_; }
  int samples() const { return counted_; }  ///< that count

  double offset() const { return mean_; }  ///< N
  /// N, standard deviation, increased by two of its own standard errors to be on the safe side.
  double deviation() const;

 private:
  void count(double force);
  bool rises(double force);

  std::size_t wanted_;
  double floor_, change_;  ///< N
  std::vector<double> samples_;
  bool ready_ = false;
  double mean_ = 0;     ///< N
  double squares_ = 0;  ///< N^2, of the deviations from the mean (Welford's sums)
  int counted_ = 0;
  double start_ = 0;       ///< N, mean of the first samples
  double rise_ = 0;        ///< N, the cumulative sum
  std::size_t onset_ = 0;  ///< samples before the rise
};

/// The number of standard deviations that a normal deviate exceeds with a probability in (0, 0.5).
double normalQuantile(double probability);

}  // namespace microinjection
