#pragma once

#include <string>
#include <vector>

#include "cell/identification/rival_cells.h"
#include "cell/identification/shape_fit.h"

namespace microinjection {

/// The estimated cell.
struct EstimatedCell {
  AxisShape shape;
  double law_error = 0;  ///< relative, median, of its force
};

/// What a record says of a cell against its rivals.
struct RivalComparison {
  ShapeFit own;
  std::string best;         ///< of the rivals
  double best_modulus = 0;  ///< Pa, of its outermost layer
  /// What the best rival gains by Akaike's criterion: the drop of the sum of squares over independent
  /// samples and the estimated cell's own error, less twice its two free ratios.
  double advantage = 0;
  /// Pa, of the outermost layer, over all cells that follow the record as well as the estimated one.
  double modulus_low = 0, modulus_high = 0;

  /// Another cell is clearly better: above 10, the worse model has essentially no support (Burnham and
  /// Anderson, "Model Selection and Multimodel Inference", 2002, 2.6).
  bool contradicts() const { return advantage > 10; }
  /// The moduli of all cells that follow the record as well agree within a quarter.
  bool layersAreKnown() const { return modulus_high < 1.25 * own.modulus && 1.25 * modulus_low > own.modulus; }
};

/// Fits all cells to the samples. `start`: of the estimated cell's fit.
RivalComparison compareWithRivals(const EstimatedCell& estimated, const std::vector<RivalCell>& rivals,
                                  const AxisSamples& samples, const ShapeFitConfig& config, const ShapeFit& start);

}  // namespace microinjection
