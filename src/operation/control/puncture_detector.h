#pragma once

#include <vector>

#include "operation/control/force_noise.h"

namespace microinjection {

/// Detects a puncture: the force falls suddenly although the needle advances.
///
/// Compares the mean force of the last m samples with that of m samples before, for m = 4, 8,
/// ... 256 at once: a large fall is detected within milliseconds, a small one as soon as the noise
/// allows. A fall counts
/// - when it exceeds what noise reaches once in 1 / false_rate samples,
/// - when it exceeds a share of the force,
/// - when the needle advanced in both windows and was deeper on average in the later one.
///
/// A stop (relaxation), a withdrawal or a slowing or trembling hand is therefore no puncture. The
/// speed may fall to half in the short windows (up to 64 samples) and to nine tenths in the longer
/// ones: the force of an elastic or relaxing cell does not fall while the speed stays.
///
/// A membrane that tears while the shaft is rubbed, or one that fades within the window, takes less away, and the ramp
/// before it hides a part of the fall. So two fifths of the share are enough for a needle that goes steadily: over
/// three times what is compared, and over all that is known to 2048 samples, it has not been faster, nor slower since
/// the earlier window, which may end up to 4 m samples before the later one.
class PunctureDetector {
 public:
  /// @param noise       of the force at rest
  /// @param drop_share  smallest fall, as a share of the force before, in (0, 1)
  /// @param false_rate  false alarms a sample under a force that does not fall, in (0, 0.01): an
  ///                    upper bound (the windows' tests count as independent)
  /// @param pause       samples without detection after a puncture, while the remaining force falls
  PunctureDetector(const ForceNoise& noise, double drop_share, double false_rate, int pause);

  /// Adds a sample: force (N, along the pipette, above that at rest) and travel (m, into the cell).
  /// Returns whether it completes a puncture; detection begins anew after the pause.
  bool step(double force, double travel);
  void reset() { count_ = 0; }  ///< begins anew, without a pause

  /// Samples to detect the smallest fall that counts at any speed, `drop_share`, from a force (N, above the offset),
  /// with one miss in 50.
  double latency(double force) const;
  /// A step without a sample: the pause after a puncture is a time of the cell.
  void wait() { paused_ -= paused_ > 0 ? 1 : 0; }
  double meanForce(int samples) const;  ///< N above the offset, of the last samples (at most 2048) since it was reset

 private:
  struct Sample {
    double force_sum = 0;   ///< N, of all samples so far
    double travel_sum = 0;  ///< m, same
    double travel = 0;      ///< m
  };
  const Sample& before(int samples) const {
    return ring_[static_cast<std::size_t>(count_ - 1 - samples) % ring_.size()];
  }
  /// The force from the window that ends `lag` samples before the last one.
  bool fell(int window, int lag) const;
  bool isSteady(int window, int lag) const;

  double deviation_;  ///< N
  double drop_share_;
  double quantile_;
  std::vector<Sample> ring_;
  long count_ = 0;
  int pause_, paused_ = 0;  ///< samples
};

}  // namespace microinjection
