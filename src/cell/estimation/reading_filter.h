#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "base/repetition.h"

namespace microinjection {

/// Which readings of a force sensor can be trusted: not a single one far off, none of a sensor that
/// repeats itself. A steady change of the force is none of both. Does not allocate.
class ReadingFilter {
 public:
  enum class Verdict { kGood, kUnknown, kOutlier, kFrozen };

  /// `time`: s; `force`: N; `noise`: N, standard deviation of a reading.
  Verdict judge(double time, double force, double noise);
  /// Why nothing is learned from the newest readings; empty while most of them are good.
  std::string complaint() const;
  void reset() { *this = {}; }

 private:
  bool isOutlier(double noise) const;

  static constexpr std::size_t kWindow = 7;
  static constexpr double kFrozen = 19;  ///< readings that repeat one: a sensor that hangs
  struct Reading {
    double time = 0, force = 0;
  };
  std::array<Reading, kWindow> window_{};  ///< the newest, in a ring
  std::size_t received_ = 0;
  Repetition<double> repetition_{kFrozen};  ///< N, exposed to readings
  double outliers_ = 0;                     ///< share among the newest readings
};

}  // namespace microinjection
