#pragma once

#include <vector>

#include "operation/control/force_noise.h"

namespace microinjection {

/// The limit h of Page's cumulative sum with the allowance k (both in units of the noise) by the mean distance of false
/// alarms (Siegmund, "Sequential analysis", 1985: (exp(2 k b) - 2 k b - 1) / (2 k^2) samples, b = h + 1.166).
/// @param false_rate  false alarms a sample, in (0, 0.01)
double pageLimit(double k, double false_rate);

/// Detects the first contact in a noisy force along the pipette by Page's cumulative sum
/// ("Continuous inspection schemes", Biometrika 1954). Of all tests with a given rate of false
/// alarms it is the fastest to detect a lasting change of its design size. In units of the noise,
///     S <- max(0, S + z - k), alarm at S > h,
/// where k is half of the design change.
///
/// The offset follows the sensor's drift: an exponential mean over 1000 samples, delayed by 128
/// samples, so that a contact is detected before it enters the offset. A needle that creeps into a
/// soft cell causes a force that rises as slowly as a drift. The offset is therefore frozen while
/// the needle creeps, and never moves by more than four times the contact force.
class ContactDetector {
 public:
  /// @param noise       of the force at rest
  /// @param force       N, design change; a smaller one is detected later, one below half never
  /// @param false_rate  false alarms a sample, in (0, 0.01), which set h: see pageLimit()
  ContactDetector(const ForceNoise& noise, double force, double false_rate);

  /// Adds a sample (N, along the pipette, positive where the cell pushes back), taken after an
  /// `advance` (m) into the cell. Returns whether there is contact.
  bool step(double force, double advance = 0);
  void reset() { sum_ = 0; }

  double offset() const { return offset_; }  ///< N, as followed until contact

 private:
  bool isCreeping() const;

  double offset_ = 0, deviation_ = 1;   ///< N
  double start_offset_, offset_range_;  ///< N, offset at the start, and its largest change
  double creep_limit_;                  ///< m a sample, below which a soft cell's force looks like drift
  double advance_ = 0;                  ///< m a sample, recent mean
  double allowance_, limit_;            ///< k and h
  double sum_ = 0;
  std::vector<double> recent_;  ///< N, ring buffer of the last samples
  long count_ = 0;
};

}  // namespace microinjection
