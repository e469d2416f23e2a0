#pragma once

#include <string>
#include <vector>

#include "cell/model/scene.h"

namespace microinjection {

/// A parameter of a cell that may change while the cell is served, SI units.
struct CellParameter {
  std::string name;
  double value = 0;
};

/// diameter (m), young_modulus (Pa, of the outermost layer), poisson_ratio (of all layers),
/// surface_tension (N/m, of the outer surface); for a cell of two layers also shell_thickness (m) and
/// core_modulus (Pa).
std::vector<CellParameter> cellParameters(const Scene& scene);

/// The scene with these values; the others stay. A new diameter scales all layers, so that
/// shell_thickness changes with it unless it is given, too. Holding pipette and tip stay. Throws
/// ConfigError that names the parameter, its value and what is allowed.
Scene withParameters(const Scene& scene, const std::vector<CellParameter>& parameters);

}  // namespace microinjection
