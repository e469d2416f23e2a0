#pragma once

#include <array>
#include <string>
#include <vector>

#include "operation/display/surface_quantity.h"

namespace microinjection {

/// What tells one cell from another in what the simulator reports of it.
struct CellIdentity {
  std::vector<std::string> parameters;  ///< names
  std::vector<double> values;           ///< SI, of the parameters
  std::vector<double> radii;            ///< m, of the layers
  std::string material;
  bool operator==(const CellIdentity& other) const;
};

/// Upper ends of the colour scales: those of the largest values so far of one cell, so that a colour keeps its meaning
/// during an injection.
class ColourRanges {
 public:
  /// Forgets the values of another cell.
  void setCell(const CellIdentity& cell);
  /// End (SI) of the scale that shows these values (NaN: not known), too.
  double include(SurfaceQuantity quantity, const std::vector<double>& values);
  /// N, largest tension of the cables so far, with this one.
  double includeTension(double tension);

 private:
  CellIdentity cell_;
  std::array<double, 4> ends_{};  ///< SI, of each SurfaceQuantity; 0: none
  double tension_ = 0;            ///< N
};

}  // namespace microinjection
