#pragma once

#include <vector>

#include "operation/control/force_noise.h"

namespace microinjection {

/// Feels the membrane give way: the force falls suddenly although the needle advances.
///
/// Means of the force over the last m samples and over the m before are compared, for m = 4, 8, ... 256 at once: a
/// large fall is found within milliseconds, a small one as soon as the noise allows. It counts where it exceeds both
/// what noise does once in 1 / false_rate samples and a share of the force, and where the needle went on through both
/// windows, and was deeper in the later one on the mean: at a stop (relaxation), a withdrawal, a slowing or trembling
/// hand nothing is found. Through the short windows (up to 64 samples) the speed may fall to half, through the longer
/// ones to nine tenths: an elastic or relaxing cell's force does not fall while the speed does not.
class PunctureDetector {
 public:
  /// @param noise       of the force at rest
  /// @param drop_share  smallest fall, of the force before, in (0, 1)
  /// @param false_rate  false alarms a sample under a force that does not fall, in (0, 0.01): an upper bound (the
  ///                    windows' tests are taken as independent)
  /// @param pause       samples after a puncture in which nothing is looked for: what is left of the force still falls
  PunctureDetector(const ForceNoise& noise, double drop_share, double false_rate, int pause);

  /// One more sample: force (N, along the pipette, above that at rest) and travel (m, into the cell); true: punctured
  /// just now. Starts afresh after that and the pause.
  bool step(double force, double travel);
  void reset() { count_ = 0; }  ///< afresh, without a pause

  /// Samples that it takes to find the smallest fall that counts from a force (N, above offset), with a miss in 50.
  double latency(double force) const;
  double meanForce(int samples) const;  ///< N above the offset, of the last samples (at most 512) since it was reset

 private:
  struct Sample {
    double force_sum = 0;   ///< N, of all until now
    double travel_sum = 0;  ///< m, same
    double travel = 0;      ///< m
  };
  const Sample& before(int samples) const {
    return ring_[static_cast<std::size_t>(count_ - 1 - samples) % ring_.size()];
  }
  bool fell(int window) const;

  double deviation_;  ///< N
  double drop_share_;
  double quantile_;
  std::vector<Sample> ring_;
  long count_ = 0;
  int pause_, paused_ = 0;  ///< samples
};

}  // namespace microinjection
