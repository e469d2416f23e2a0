#pragma once

#include <functional>
#include <vector>

#include "cell/identification/elastic_law.h"

namespace microinjection {

/// The force on the axis of a cell of a modulus of 1 Pa, from a table: nanoseconds, where a member of a
/// family takes a microsecond. Interpolates force / depth^1.5, which varies slowly for a round tip, over
/// the root of the depth. Below the deepest entry the force goes on straight.
class AxisShape {
 public:
  /// `force`: N/Pa at a depth (m) > 0. @pre deepest > 0 (m)
  AxisShape(const std::function<double(double)>& force, double deepest);

  ElasticLaw::Value at(double depth) const;  ///< zero above the contact
  double deepest() const { return deepest_; }

 private:
  double deepest_;              ///< m
  std::vector<double> values_;  ///< N/Pa, force over (depth / deepest)^1.5 at equal steps of the root
};

}  // namespace microinjection
