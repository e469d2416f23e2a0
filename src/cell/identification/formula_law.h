#pragma once

#include <memory>
#include <string>

#include "cell/identification/elastic_law.h"
#include "cell/model/scene.h"

namespace microinjection {

/// What the formulas of the literature take of a scene.
struct FormulaGeometry {
  double tip_radius = 0;  ///< m, of a paraboloid or, for a cone, unused
  double half_angle = 0;  ///< rad, of a cone
  double poisson_ratio = 0.5;
  double cell_radius = 0;      ///< m; 0: a half space
  double shell_thickness = 0;  ///< m; 0: no shell
  double dimple_radius = 0;    ///< m, of the membrane; 0: none

  static FormulaGeometry of(const Scene& scene);
};

/// hertz: paraboloid on a half space, or on a sphere of the cell's radius (Hertz 1881; Johnson,
/// "Contact Mechanics", 4.2). cone: Sneddon 1965. shell: a point load on a sphere's thin shell
/// (Reissner 1946). membrane: see Biomembrane. The modulus is that of the half space or of the
/// shell. Throws ConfigError when the geometry lacks something.
std::unique_ptr<ElasticLaw> makeFormulaLaw(const std::string& name, const FormulaGeometry& geometry);

}  // namespace microinjection
