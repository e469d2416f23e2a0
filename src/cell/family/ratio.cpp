#include "cell/family/ratio.h"

#include <cmath>
#include <string>

#include "cell/model/similarity.h"

namespace microinjection {

const std::vector<Ratio>& ratios() {
  static const std::vector<Ratio> all = {
      {"tip_radius", true, 1, [](const Scene& scene) { return scene.needle.tip.radius; },
       [](Scene& scene, double value) { scene.needle.tip.radius = rounded(value); }},
      {"holding_radius", false, 1, [](const Scene& scene) { return scene.holding_pipette.contact_radius; },
       [](Scene& scene, double value) { scene.holding_pipette.contact_radius = rounded(value); }},
      {"poisson_ratio", false, 1, [](const Scene& scene) { return scene.cell.material().poisson_ratio; },
       [](Scene& scene, double value) {
         for (Scene::Layer& layer : scene.cell.layers) layer.material.poisson_ratio = rounded(value);
       }},
      {"surface_tension", false, 1, [](const Scene& scene) { return scene.cell.layers[0].surface_tension; },
       [](Scene& scene, double value) { scene.cell.layers[0].surface_tension = rounded(value); }},
      {"shell_thickness", true, 2, [](const Scene& scene) { return 1 - scene.cell.layers[1].outer_radius; },
       [](Scene& scene, double value) { scene.cell.layers[1].outer_radius = rounded(1 - value); }},
      {"core_modulus", true, 2, [](const Scene& scene) { return scene.cell.layers[1].material.young_modulus; },
       [](Scene& scene, double value) { scene.cell.layers[1].material.young_modulus = rounded(value); }}};
  return all;
}

const std::vector<Ratio>& mouthRatios() {
  using Mouth = Scene::Mouth;
  static const std::vector<Ratio> all = [] {
    std::vector<Ratio> result = {
        {"bore_radius", true, 1, [](const Scene& scene) { return scene.holding_pipette.mouth->inner_radius; },
         [](Scene& scene, double value) { scene.holding_pipette.mouth->inner_radius = rounded(value); }},
        {"lip_edge", true, 1,
         [](const Scene& scene) {
           const Mouth& mouth = *scene.holding_pipette.mouth;
           return mouth.edge_radius / mouth.inner_radius;
         },
         [](Scene& scene, double value) {
           Mouth& mouth = *scene.holding_pipette.mouth;
           mouth.edge_radius = rounded(value * mouth.inner_radius);
         }},
        {"wall", true, 1,
         [](const Scene& scene) {
           const Mouth& mouth = *scene.holding_pipette.mouth;
           return (mouth.outer_radius - mouth.inner_radius) / (2 * mouth.edge_radius);
         },
         [](Scene& scene, double value) {
           Mouth& mouth = *scene.holding_pipette.mouth;
           mouth.outer_radius = rounded(mouth.inner_radius + 2 * value * mouth.edge_radius);
         }},
        {"suction_root", false, 1, [](const Scene& scene) { return std::sqrt(-scene.holding_pipette.mouth->pressure); },
         [](Scene& scene, double value) { scene.holding_pipette.mouth->pressure = rounded(-value * value); }}};
    for (const Ratio& ratio : ratios()) {
      const std::string name = ratio.name;
      if (name != "holding_radius" && name != "surface_tension") result.push_back(ratio);
    }
    return result;
  }();
  return all;
}

namespace {

/// J/m^2 for a toughness of 1: shear modulus times tip's radius.
double toughnessUnit(const Scene& scene) {
  return scene.cell.material().young_modulus / (2 + 2 * scene.cell.material().poisson_ratio) * scene.needle.tip.radius;
}

}  // namespace

const std::vector<Ratio>& needleRatios() {
  static const std::vector<Ratio> all = [] {
    std::vector<Ratio> result;
    for (const Ratio& ratio : ratios()) {
      if (ratio.layers == 1 && ratio.name != std::string("surface_tension")) result.push_back(ratio);
    }
    result.push_back({"friction", true, 1, [](const Scene& scene) { return scene.needle.contact.friction; },
                      [](Scene& scene, double value) { scene.needle.contact.friction = rounded(value); }});
    result.push_back(
        {"toughness", true, 1,
         [](const Scene& scene) { return scene.cell.puncture.layers.front().toughness / toughnessUnit(scene); },
         [](Scene& scene, double value) {
           scene.cell.puncture.layers.front().toughness = rounded(value * toughnessUnit(scene));
         }});
    result.push_back(
        {"adhesion_root", false, 1,
         [](const Scene& scene) { return std::sqrt(scene.needle.contact.adhesion_energy / scene.needle.tip.radius); },
         [](Scene& scene, double value) {
           scene.needle.contact.adhesion_energy = rounded(value * value * scene.needle.tip.radius);
         }});
    result.push_back({"adhesion_range", true, 1,
                      [](const Scene& scene) { return scene.needle.contact.adhesion_range / scene.needle.tip.radius; },
                      [](Scene& scene, double value) {
                        scene.needle.contact.adhesion_range = rounded(value * scene.needle.tip.radius);
                      }});
    return result;
  }();
  return all;
}

}  // namespace microinjection
