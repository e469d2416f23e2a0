#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "cell/model/pierced_branch.h"
#include "cell/model/puncture_config.h"

namespace microinjection {

/// How much tougher a pierced layer is for the speed v at which the needle goes in, and where it is pierced then:
///
///     J(v) = J (1 + (v / v0)^n)
///
/// as of cracks in viscoelastic solids (Persson and Brener, Phys. Rev. E 71 (2005) 036123: the energy of a slow crack
/// times one and a power of its speed). A long hole grows as fast as the needle goes; at the onset the crack is faster
/// for a moment, which is left out. The hole's radius stays that of a slow needle. Onsets are found beforehand.
class CrackSpeed {
 public:
  CrackSpeed(const PiercedBranch& branch, const PunctureConfig::ToughnessRate& rate);

  /// The needle has gone in by `advance` (m; below 0: out) in `duration` (s). Does not allocate.
  void step(double advance, double duration);
  void reset() { speed_ = 0, tougher_ = 1; }
  double tougher() const { return tougher_; }  ///< times the toughness of a slow needle
  /// N, of the whole cell's force, and m, of the hole, at the onset; infinite: nothing that is solved pierces it
  double onsetForce() const { return at(&PiercedBranch::Onset::force); }
  double onsetLength() const { return at(&PiercedBranch::Onset::length); }

 private:
  double at(double PiercedBranch::Onset::*value) const;

  PunctureConfig::ToughnessRate rate_;
  std::vector<PiercedBranch::Onset> onsets_;  ///< at equal steps of the logarithm of tougher(), from 1
  double speed_ = 0;                          ///< m/s, into the cell, smoothed
  double tougher_ = 1;
};

}  // namespace microinjection
