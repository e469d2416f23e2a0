#include "cell/identification/identified_scene.h"

#include <yaml-cpp/yaml.h>

#include <cstdio>
#include <filesystem>
#include <sstream>

#include "cell/material/material_parameter.h"
#include "cell/model/scene.h"

namespace microinjection {
namespace {

YAML::Node materialOf(YAML::Node cell, std::size_t layer) {
  return cell["layers"] ? cell["layers"][layer]["material"] : cell["material"];
}

std::string interval(const Estimate& estimate) {
  char text[160];
  std::snprintf(text, sizeof(text), "# %s = %.4g %s, 95 %% interval [%.4g, %.4g]\n", estimate.name.c_str(),
                estimate.value, estimate.unit.c_str(), estimate.low, estimate.high);
  return text;
}

void setProny(YAML::Node material, const Identification& identification) {
  YAML::Node terms;
  for (int k = 1;; ++k) {
    const std::string number = identification.find("modulus_ratio") ? "" : "_" + std::to_string(k);
    const Estimate* share = identification.find("modulus_ratio" + number);
    if (!share) break;
    YAML::Node term;
    term["modulus_ratio"] = share->value;
    term["relaxation_time"] = identification.find("relaxation_time" + number)->value;
    terms.push_back(term);
    if (number.empty()) break;
  }
  // Without terms, the record was fitted as elastic: so is the scene.
  if (terms.size() > 0) {
    material["viscoelasticity"]["prony"] = terms;
  } else {
    material.remove("viscoelasticity");
  }
}

}  // namespace

std::string identifiedScene(const std::string& scene_path, const std::string& record_path,
                            const Identification& identification) {
  const Scene scene = loadScene(scene_path);
  YAML::Node node = YAML::LoadFile(scene_path);
  YAML::Node cell = node["cell"];
  const double factor = identification.find("young_modulus")->value / scene.cell.material().young_modulus;
  const double radius = scene.radius();
  for (std::size_t i = 0; i < scene.cell.layers.size(); ++i) {
    YAML::Node material = materialOf(cell, i);
    material["young_modulus"] = factor * scene.cell.layers[i].material.young_modulus;
    setProny(material, identification);
  }
  if (const Estimate* ratio = identification.find("core_modulus"))
    materialOf(cell, 1)["young_modulus"] = ratio->value * identification.find("young_modulus")->value;
  if (const Estimate* ratio = identification.find("shell_thickness"))
    cell["layers"][1]["outer_radius"] = radius * (1 - ratio->value);
  if (const Estimate* ratio = identification.find("tip_radius"))
    node["needle"]["tip"]["radius"] = radius * ratio->value;
  if (const Estimate* ratio = identification.find("poisson_ratio")) {
    for (std::size_t i = 0; i < scene.cell.layers.size(); ++i) materialOf(cell, i)["poisson_ratio"] = ratio->value;
  }
  for (const MaterialParameter& each : materialParameters()) {
    const Estimate* const found = each.ofAllModels() ? nullptr : identification.find(each.name);
    for (std::size_t i = 0; found && i < scene.cell.layers.size(); ++i) {
      if (scene.cell.layers[i].material.model == each.model) materialOf(cell, i)[each.name] = found->value;
    }
  }
  parseScene(node, "the identified scene");
  std::ostringstream out;
  out << "# " << std::filesystem::path(scene_path).filename().string() << " with what was identified from "
      << std::filesystem::path(record_path).filename().string() << " by `identify`.\n# " << identification.model
      << '\n';
  for (const Estimate& estimate : identification.estimates) out << interval(estimate);
  YAML::Emitter emitter;
  emitter.SetDoublePrecision(6);
  emitter << node;
  out << emitter.c_str() << '\n';
  return out.str();
}

}  // namespace microinjection
