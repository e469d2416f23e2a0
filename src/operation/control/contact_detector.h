#pragma once

#include <vector>

#include "operation/control/force_noise.h"

namespace microinjection {

/// Feels the first touch in a noisy force along the pipette: Page's cumulative sum ("Continuous inspection schemes",
/// Biometrika 1954), which of all tests with a given rate of false alarms finds a lasting change of the size that it is
/// made for soonest. In units of the noise, S <- max(0, S + z - k), alarm at S > h, with k half of the change looked
/// for. The offset follows a sensor's drift: an exponential mean over 1000 samples, 128 samples late, so that a touch
/// is felt before it is taken for drift. A needle that creeps into a soft cell makes a force that rises as slowly as a
/// drift: while it creeps the offset rests, and it never goes farther than four times the contact force.
class ContactDetector {
 public:
  /// @param noise       of the force at rest
  /// @param force       N, change that is looked for; a smaller one is found later or never (below half of it)
  /// @param false_rate  false alarms a sample, in (0, 0.01): h is such that they are so far apart on average (Siegmund,
  ///                    "Sequential analysis", 1985: (exp(2 k b) - 2 k b - 1) / (2 k^2) samples, b = h + 1.166)
  ContactDetector(const ForceNoise& noise, double force, double false_rate);

  /// One more sample (N, along the pipette, positive where the cell pushes back), `advance` (m) into the cell after
  /// the last; true: touched.
  bool step(double force, double advance = 0);
  void reset() { sum_ = 0; }

  double offset() const { return offset_; }        ///< N, followed up to the touch
  double allowance() const { return allowance_; }  ///< k
  double limit() const { return limit_; }          ///< h

 private:
  bool isCreeping() const;

  double offset_ = 0, deviation_ = 1;  ///< N
  double rest_, farthest_;             ///< N, offset at the start, and how far it may go from there
  double creep_;                       ///< m a sample, below which a soft cell's force could pass for drift
  double advance_ = 0;                 ///< m a sample, mean of the last
  double allowance_, limit_;
  double sum_ = 0;
  std::vector<double> late_;  ///< N, a ring of the last samples
  long count_ = 0;
};

}  // namespace microinjection
