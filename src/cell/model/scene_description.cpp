#include "cell/model/scene_description.h"

#include <sstream>

namespace microinjection {

std::string describeCellAndTip(const Scene& scene) {
  std::ostringstream out;
  out << std::hexfloat;
  for (const Scene::Layer& layer : scene.cell.layers) {
    const MaterialConfig& material = layer.material;
    out << "layer " << layer.outer_radius << " tension " << layer.surface_tension << ' ' << material.model << ' '
        << material.young_modulus << ' ' << material.poisson_ratio << ' ' << material.mooney_ratio;
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
