#include "cell/model/cell_parameters.h"

#include <algorithm>
#include <sstream>

#include "base/errors.h"
#include "base/range.h"

namespace microinjection {
namespace {

[[noreturn]] void refuse(const CellParameter& parameter, const std::string& allowed) {
  std::ostringstream message;
  message << parameter.name << " = " << parameter.value << ": must be " << allowed;
  throw ConfigError(message.str());
}

void set(Scene& scene, const CellParameter& parameter) {
  std::vector<Scene::Layer>& layers = scene.cell.layers;
  const double value = parameter.value;
  if (parameter.name == "diameter") {
    const double factor = value / scene.cell.diameter();
    for (Scene::Layer& layer : layers) layer.outer_radius *= factor;
  } else if (parameter.name == "young_modulus") {
    layers[0].material.young_modulus = value;
  } else if (parameter.name == "poisson_ratio") {
    for (Scene::Layer& layer : layers) layer.material.poisson_ratio = value;
  } else if (parameter.name == "surface_tension") {
    layers[0].surface_tension = value;
  } else if (parameter.name == "shell_thickness") {
    if (!(value < scene.radius())) refuse(parameter, "less than the cell's radius");
    layers[1].outer_radius = scene.radius() - value;
  } else {
    layers[1].material.young_modulus = value;
  }
}

}  // namespace

std::vector<CellParameter> cellParameters(const Scene& scene) {
  const std::vector<Scene::Layer>& layers = scene.cell.layers;
  const MaterialConfig& material = scene.cell.material();
  if (scene.cell.tensegrity) return {{"diameter", scene.cell.diameter()}};
  std::vector<CellParameter> parameters = {{"diameter", scene.cell.diameter()},
                                           {"young_modulus", material.young_modulus},
                                           {"poisson_ratio", material.poisson_ratio},
                                           {"surface_tension", layers[0].surface_tension}};
  if (layers.size() == 2) {
    parameters.push_back({"shell_thickness", scene.radius() - layers[1].outer_radius});
    parameters.push_back({"core_modulus", layers[1].material.young_modulus});
  }
  return parameters;
}

Scene withParameters(const Scene& scene, const std::vector<CellParameter>& parameters) {
  Scene result = scene;
  std::string names;
  // In the order of the known ones: the diameter first, because it scales the shell.
  for (const CellParameter& known : cellParameters(scene)) {
    names += (names.empty() ? "" : ", ") + known.name;
    for (const CellParameter& parameter : parameters) {
      if (parameter.name != known.name) continue;
      const bool may_be_zero = parameter.name == "surface_tension";
      const Range allowed = parameter.name == "poisson_ratio" ? Range::open(-1, 0.5)
                            : may_be_zero                     ? Range::nonNegative()
                                                              : Range::positive();
      if (!allowed.contains(parameter.value)) refuse(parameter, "in " + allowed.text());
      set(result, parameter);
    }
  }
  for (const CellParameter& parameter : parameters) {
    const std::string delimited = ", " + names + ",";
    if (delimited.find(", " + parameter.name + ",") == std::string::npos) {
      throw ConfigError(parameter.name + ": is no parameter of this cell; these are: " + names);
    }
  }
  result.validate();
  return result;
}

}  // namespace microinjection
