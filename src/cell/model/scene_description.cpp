#include "cell/model/scene_description.h"

#include <sstream>

#include "cell/material/material_parameter.h"

namespace microinjection {

namespace {

/// A new number changes the identity of the cells alone that have it: the surrogate data of all others stay good.
bool isDescribed(const MaterialParameter& parameter, const std::string& model) {
  const bool was_first = parameter.value == &MaterialConfig::mooney_ratio;  // in every text, from the beginning
  return parameter.ofAllModels() || model == parameter.model || was_first;
}

}  // namespace

std::string describeCellAndTip(const Scene& scene) {
  std::ostringstream out;
  out << std::hexfloat;
  for (const Scene::Layer& layer : scene.cell.layers) {
    const MaterialConfig& material = layer.material;
    out << "layer " << layer.outer_radius << " tension " << layer.surface_tension << ' ' << material.model;
    for (const MaterialParameter& each : materialParameters()) {
      if (isDescribed(each, material.model)) out << ' ' << material.*each.value;
    }
    for (const PronyTerm& term : material.viscoelasticity.prony) {
      out << " prony " << term.modulus_ratio << ' ' << term.relaxation_time;
    }
    out << " viscosity " << material.viscoelasticity.viscosity << ' ';
  }
  const Scene::Tip& tip = scene.needle.tip;
  out << "held " << scene.holding_pipette.contact_radius << " tip " << tip.shape << ' ' << tip.radius << ' '
      << tip.edgeRadius() << ' ' << scene.needle.contact.mode << ' ' << scene.needle.contact.friction;
  if (const std::optional<Scene::Mouth>& mouth = scene.holding_pipette.mouth) {
    out << " mouth " << mouth->inner_radius << ' ' << mouth->outer_radius << ' ' << mouth->edge_radius << ' '
        << mouth->pressure << ' ' << mouth->contact.mode << ' ' << mouth->contact.friction << ' '
        << mouth->contact.adhesion_energy << ' ' << mouth->contact.adhesion_range;
  }
  return out.str();
}

}  // namespace microinjection
