#include "cell/model/scene_description.h"

#include <sstream>

#include "cell/material/material_parameter.h"

namespace microinjection {

std::string describeCellAndTip(const Scene& scene) {
  std::ostringstream out;
  out << std::hexfloat;
  for (const Scene::Layer& layer : scene.cell.layers) {
    const MaterialConfig& material = layer.material;
    out << "layer " << layer.outer_radius << " tension " << layer.surface_tension << ' ' << material.model;
    for (const MaterialParameter& each : materialParameters()) out << ' ' << material.*each.value;
    for (const PronyTerm& term : material.viscoelasticity.prony) {
      out << " prony " << term.modulus_ratio << ' ' << term.relaxation_time;
    }
    out << " viscosity " << material.viscoelasticity.viscosity << ' ';
  }
  const Scene::Tip& tip = scene.needle.tip;
  out << "held " << scene.holding_pipette.contact_radius << " tip " << tip.shape << ' ' << tip.radius << ' '
      << tip.edgeRadius() << ' ' << scene.needle.contact.mode << ' ' << scene.needle.contact.friction;
  return out.str();
}

}  // namespace microinjection
