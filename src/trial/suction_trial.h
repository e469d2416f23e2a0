#pragma once

#include "trial/hand_trial.h"
#include "trial/injection_case.h"
#include "trial/injection_rig.h"

namespace microinjection {

/// An injection of a random cell (randomSuctionCase) whose membrane the controller breaks by suction, in a dent, with a
/// noisy force sensor and, where they are seen, images of the interface in the bore.
struct SuctionTrial {
  InjectionCase of;
  bool breaks = true;  ///< its membrane gives way to suction
  InjectionRig::Truth truth;
  InjectionResult result;
  /// Each millisecond, from the dent on.
  struct Sample {
    double time = 0;     ///< s
    double suction = 0;  ///< Pa, that the controller asks for
    double force = 0;    ///< N, along the pipette, as the sensor reads it
    double length = 0;   ///< m, of what is truly in the bore
  };
  std::vector<Sample> samples;

  /// @param tongue of any needle: a bore is small against its cell
  /// What tells the controller of the break.
  enum class Witnesses { kBoth, kForce, kImage };
  static SuctionTrial run(const TrialCell& cell, const BoreTongue& tongue, int seed, Witnesses witnesses);
};

}  // namespace microinjection
