#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "cell/model/scene.h"
#include "cell/surrogate/surrogate_data.h"

namespace microinjection {

/// Depth and force at which the outermost layer is expected to fail: medians and intervals.
struct PuncturePrediction {
  double depth = 0, depth_low = 0, depth_high = 0;  ///< m, past the contact point
  double force = 0, force_low = 0, force_high = 0;  ///< N, along the pipette
  double beyond = 0;  ///< probability that it fails deeper than the surrogate's range, which counts as its end
};

/// Predicts the puncture of a cell from its failure law and from what is known of its modulus.
///
/// The limits of the scene's outermost layer (force, depth, strain; the first one to be reached counts)
/// have a common log-normal factor: how much stronger this cell's membrane is than the scene's. The
/// modulus is log-normal, too. Draws that fail before the present depth are left out, since this cell has
/// not failed there. Without force memory: slow relaxation moves a force limit deeper.
class PuncturePredictor {
 public:
  /// `cell`: the member of a family that `scene` is. `deviation`: prior standard deviation of the
  /// logarithm of the failure law's factor.
  PuncturePredictor(const Scene& scene, std::shared_ptr<const SurrogateData> cell, double deviation);

  /// `modulus`: Pa, median; `modulus_deviation`: of its logarithm; `depth`: m, deepest so far;
  /// `share`: probability of the intervals. Empty when the cell cannot be punctured, or should have been.
  /// Tenths of a millisecond.
  std::optional<PuncturePrediction> predict(double modulus, double modulus_deviation, double depth,
                                            double share = 0.95) const;

 private:
  double forceAt(double depth) const;  ///< N, of the scene's modulus
  double depthAt(double force) const;  ///< m; that of the range's end for a larger force

  std::optional<PunctureConfig::Layer> layer_;
  double modulus_, tip_radius_, deviation_;
  Eigen::VectorXd depths_, forces_;  ///< m, N, on the axis
};

}  // namespace microinjection
