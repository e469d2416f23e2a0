#pragma once

#include <cstdint>
#include <random>
#include <vector>

namespace microinjection {

/// Standard normal deviates by the Box-Muller method. Unlike std::normal_distribution, it gives the
/// same values with every standard library.
class StandardNormal {
 public:
  explicit StandardNormal(std::uint64_t seed) : random_(seed) {}
  double next();

 private:
  std::mt19937_64 random_;
};

/// Noise of electronics on a signal sampled at fs (Hz): one-sided density S^2 (1 + fc / f), a
/// random walk of k per root second, and a steady drift of r per second.
struct NoiseConfig {
  double density = 0;         ///< S, unit/sqrt(Hz), one-sided
  double flicker_corner = 0;  ///< fc, Hz, in [0, fs / 10]: below it 1/f noise exceeds white noise
  double random_walk = 0;     ///< k, unit/sqrt(s)
  double drift_rate = 0;      ///< r, unit/s
};

/// The noise of one axis, sample by sample.
///
/// White noise is band-limited to fs / 2 before sampling, so the variance of a sample is S^2 fs /
/// 2. 1/f noise is a sum of first-order low-pass processes with corners a factor rho apart. Each of
/// variance v has the one-sided density (2 v / (pi f_k)) / (1 + (f / f_k)^2). The sum is v / (f ln
/// rho), so v = S^2 fc ln rho. It ends at 1 mHz.
class Noise {
 public:
  Noise(const NoiseConfig& config, double sample_rate, StandardNormal& normal);

  double sample(StandardNormal& normal);

 private:
  struct LowPass {
    double keep;    ///< share of the value that remains after a sample
    double spread;  ///< standard deviation of the new part of a sample
    double value;
  };

  NoiseConfig config_;
  double period_;  ///< s
  double white_;   ///< standard deviation of a sample
  double walk_ = 0;
  double drift_ = 0;
  std::vector<LowPass> flicker_;
};

}  // namespace microinjection
