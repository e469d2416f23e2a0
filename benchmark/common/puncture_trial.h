#pragma once

#include <memory>
#include <random>
#include <string>

#include "benchmark/common/drawn_cell.h"

namespace microinjection {

/// How well a puncture was predicted when the needle was at half of its depth.
struct PunctureScore {
  std::string law;                                ///< the limit that failed: force, depth or strain
  double depth = 0;                               ///< m, of the puncture
  double force_error = 0;                         ///< relative, of the predicted median
  double depth_error = 0;                         ///< same
  bool predicted = false;                         ///< else there was no prediction, and all else is 0
  bool force_in_50 = false, force_in_90 = false;  ///< whether the interval with that share covers
  bool depth_in_50 = false, depth_in_90 = false;
};

/// Draws a failure law of `cell` with a limit of force, depth or strain, and how much stronger this cell's
/// membrane is than the law says: a factor, log-normal with the standard deviation `strength`, which
/// the prediction knows, too. A needle at 20 um/s and the virtual force sensor then indent the cell to
/// half of the puncture's depth; the cell estimator's estimate there is what predicts. The estimator's prior is
/// off by up to a factor of 2.7.
PunctureScore runPunctureTrial(const DrawnCell& cell, const std::shared_ptr<const FamilyData>& family, double strength,
                               int seed, std::mt19937& random);

}  // namespace microinjection
