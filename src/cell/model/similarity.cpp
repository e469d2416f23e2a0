#include "cell/model/similarity.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "cell/material/material_parameter.h"

namespace microinjection {

Similarity Similarity::of(const Scene& scene) { return {scene.radius(), scene.cell.material().young_modulus}; }

double rounded(double value) {
  char text[40];
  std::snprintf(text, sizeof(text), "%.12g", value);
  return std::strtod(text, nullptr);
}

Scene withoutDimension(const Scene& scene) {
  const Similarity units = Similarity::of(scene);
  Scene result = scene;
  const auto divide = [](double& value, double unit) { value = rounded(value / unit); };
  for (Scene::Layer& layer : result.cell.layers) {
    divide(layer.outer_radius, units.length);
    for (const MaterialParameter& each : materialParameters())
      divide(layer.material.*each.value, std::pow(units.modulus, each.stresses));
    divide(layer.surface_tension, units.modulus * units.length);
  }
  divide(result.holding_pipette.contact_radius, units.length);
  if (std::optional<Scene::Mouth>& mouth = result.holding_pipette.mouth) {
    for (double* length : {&mouth->inner_radius, &mouth->outer_radius, &mouth->edge_radius})
      divide(*length, units.length);
    divide(mouth->pressure, units.modulus);
    divide(mouth->contact.adhesion_energy, units.modulus * units.length);
    divide(mouth->contact.adhesion_range, units.length);
  }
  Scene::Needle& needle = result.needle;
  divide(needle.tip.radius, units.length);
  divide(needle.tip.edge_radius, units.length);
  divide(needle.contact.adhesion_energy, units.modulus * units.length);
  divide(needle.contact.adhesion_range, units.length);
  for (double& offset : needle.offset) divide(offset, units.length);
  for (PunctureConfig::Layer& layer : result.cell.puncture.layers) {
    divide(layer.toughness, units.modulus * units.length);
    divide(layer.barrier, units.modulus * std::pow(units.length, 3));
  }
  if (result.mesh.size) divide(*result.mesh.size, units.length);
  return result;
}

}  // namespace microinjection
