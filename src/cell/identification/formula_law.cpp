#include "cell/identification/formula_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.h"
#include "cell/model/biomembrane.h"

namespace microinjection {
namespace {

/// coefficient depth^exponent
class PowerLaw : public ElasticLaw {
 public:
  PowerLaw(std::string description, double coefficient, double exponent)
      : description_(std::move(description)), coefficient_(coefficient), exponent_(exponent) {}

  std::string description() const override { return description_; }
  Value force(double depth, Eigen::VectorXd& by_logarithms) const override {
    by_logarithms.resize(0);
    return {coefficient_ * std::pow(depth, exponent_), exponent_ * coefficient_ * std::pow(depth, exponent_ - 1)};
  }
  double deepest() const override { return std::numeric_limits<double>::infinity(); }

 private:
  std::string description_;
  double coefficient_, exponent_;
};

void require(double value, const std::string& model, const std::string& what) {
  if (!(value > 0)) throw ConfigError("--model " + model + ": needs " + what);
}

}  // namespace

FormulaGeometry FormulaGeometry::of(const Scene& scene) {
  FormulaGeometry result;
  result.tip_radius = scene.needle.tip.radius;
  result.poisson_ratio = scene.cell.material().poisson_ratio;
  result.cell_radius = scene.radius();
  const std::vector<double> radii = scene.cell.outerRadii();
  if (radii.size() > 1) result.shell_thickness = radii[0] - radii[1];
  if (scene.cell.biomembrane) {
    result.shell_thickness = scene.cell.biomembrane->thickness;
    result.dimple_radius = scene.cell.biomembrane->dimple_radius;
  }
  return result;
}

std::unique_ptr<ElasticLaw> makeFormulaLaw(const std::string& name, const FormulaGeometry& geometry) {
  const double nu = geometry.poisson_ratio, plane = 1 - nu * nu;
  if (name == "hertz") {
    require(geometry.tip_radius, name, "--tip-radius or a scene");
    const double curvature = 1 / geometry.tip_radius + (geometry.cell_radius > 0 ? 1 / geometry.cell_radius : 0);
    return std::make_unique<PowerLaw>("Hertz, paraboloid", 4.0 / 3 / std::sqrt(curvature) / plane, 1.5);
  }
  if (name == "cone") {
    require(geometry.half_angle, name, "--half-angle");
    return std::make_unique<PowerLaw>("Sneddon, cone", 2 / M_PI * std::tan(geometry.half_angle) / plane, 2);
  }
  if (name == "shell") {
    require(std::min(geometry.shell_thickness, geometry.cell_radius), name, "a scene with a shell");
    const double thickness = geometry.shell_thickness;
    return std::make_unique<PowerLaw>("Reissner, point load on a shell",
                                      4 * thickness * thickness / geometry.cell_radius / std::sqrt(3 * plane), 1);
  }
  if (name == "membrane") {
    require(geometry.dimple_radius, name, "a scene with cell/biomembrane");
    const Biomembrane membrane(1, nu, geometry.tip_radius, {geometry.shell_thickness, geometry.dimple_radius});
    return std::make_unique<PowerLaw>("Sun et al., membrane", membrane.force(1), 3);
  }
  throw ConfigError("--model " + name + ": must be family, solution, live, hertz, cone, shell or membrane");
}

}  // namespace microinjection
