#include "cell/model/plausible_scene.h"

#include <cmath>

#include "base/plausible.h"

namespace microinjection {
namespace {

/// Names each value by its path, as the scene file does.
class PlausibleCheck {
 public:
  void require(const PlausibleRange& quantity, const std::string& key, double value) {
    quantity.require(key, value, errors_);
  }
  /// A value that may be left out: infinity or 0 stand for that.
  void requireGiven(const PlausibleRange& quantity, const std::string& key, double value) {
    if (std::isfinite(value) && value != 0) require(quantity, key, value);
  }
  void throwAny() const { errors_.throwAny(); }

 private:
  ConfigErrors errors_;
};

void checkMaterial(const Scene::Layer& layer, const std::string& path, PlausibleCheck& check) {
  const std::string material = path + "material/", viscous = material + "viscoelasticity/";
  check.require(plausible::kCellModulus, material + "young_modulus", layer.material.young_modulus);
  const ViscoelasticityConfig& viscoelasticity = layer.material.viscoelasticity;
  for (std::size_t i = 0; i < viscoelasticity.prony.size(); ++i)
    check.require(plausible::kRelaxationTime, viscous + "prony/" + std::to_string(i) + "/relaxation_time",
                  viscoelasticity.prony[i].relaxation_time);
  check.require(plausible::kViscosity, viscous + "viscosity", viscoelasticity.viscosity);
  check.require(plausible::kTension, path + "surface_tension", layer.surface_tension);
}

void checkFilaments(const FilamentConfig& filaments, const std::string& path, PlausibleCheck& check) {
  check.require(plausible::kFilamentModulus, path + "young_modulus", filaments.young_modulus);
  check.require(plausible::kBendingStiffness, path + "bending_stiffness", filaments.bending_stiffness);
}

void checkTensegrity(const TensegrityConfig& cell, PlausibleCheck& check) {
  checkFilaments(cell.actin.filaments, "cell/actin/", check);
  check.require(plausible::kTime, "cell/actin/retardation_time", cell.actin.retardation_time);
  checkFilaments(cell.intermediate.filaments, "cell/intermediate_filaments/", check);
  check.require(plausible::kTime, "cell/intermediate_filaments/retardation_time", cell.intermediate.retardation_time);
  checkFilaments(cell.microtubules.filaments, "cell/microtubules/", check);
  check.require(plausible::kCellModulus, "cell/membrane/young_modulus", cell.membrane.young_modulus);
  check.require(plausible::kLength, "cell/membrane/thickness", cell.membrane.thickness);
  check.require(plausible::kTension, "cell/membrane/tension", cell.membrane.tension);
  check.require(plausible::kTime, "cell/membrane/retardation_time", cell.membrane.retardation_time);
}

void checkPuncture(const PunctureConfig& puncture, PlausibleCheck& check) {
  const std::string path = "cell/puncture/", shaft = path + "shaft/";
  for (std::size_t i = 0; i < puncture.layers.size(); ++i) {
    const PunctureConfig::Layer& layer = puncture.layers[i];
    const bool alone = puncture.layers.size() == 1 && layer.name == PunctureConfig::Layer().name;
    const std::string at = alone ? path : path + "layers/" + std::to_string(i) + "/";
    check.requireGiven(plausible::kForce, at + "force", layer.force);
    check.requireGiven(plausible::kDepth, at + "depth", layer.depth);
    check.requireGiven(plausible::kStrain, at + "strain", layer.strain);
    check.requireGiven(plausible::kToughness, at + "toughness", layer.toughness);
    check.requireGiven(plausible::kSpeed, at + "toughness_rate/speed", layer.toughness_rate.speed);
    check.require(plausible::kWork, at + "barrier", layer.barrier);
    check.requireGiven(plausible::kLength, at + "dimple_radius", layer.dimple_radius);
    check.requireGiven(plausible::kStiffness, at + "stiffness", layer.stiffness);
    check.requireGiven(plausible::kLength, at + "gap", layer.gap);
    if (!layer.aspiration) continue;
    check.require(plausible::kTension, at + "aspiration/tension", layer.aspiration->tension);
    check.require(plausible::kTension, at + "aspiration/tension_scale", layer.aspiration->tension_scale);
    check.require(plausible::kRelaxationTime, at + "aspiration/tension_time", layer.aspiration->tension_time);
  }
  check.require(plausible::kFriction, shaft + "friction", puncture.shaft.friction);
  check.require(plausible::kFrictionCoefficient, shaft + "coefficient", puncture.shaft.coefficient);
  check.requireGiven(plausible::kStiffness, shaft + "adhesion", puncture.shaft.adhesion);
  check.require(plausible::kStiffness, shaft + "stiffness", puncture.shaft.stiffness);
  check.require(plausible::kViscosity, shaft + "damping", puncture.shaft.damping);
  check.requireGiven(plausible::kStiffness, shaft + "lateral_stiffness", puncture.shaft.lateral_stiffness);
  check.requireGiven(plausible::kRelaxationTime, path + "relaxation_time", puncture.relaxation_time);
  check.require(plausible::kViscosity, path + "cytoplasm_viscosity", puncture.cytoplasm_viscosity);
  check.requireGiven(plausible::kRelaxationTime, path + "resealing_time", puncture.resealing_time);
}

void checkCell(const Scene::Cell& cell, PlausibleCheck& check) {
  const bool is_layered = cell.layers.size() > 1;
  if (is_layered)
    check.require(plausible::kCellRadius, "cell/layers/0/outer_radius", cell.radius());
  else
    check.require(plausible::kCellDiameter, "cell/diameter", cell.diameter());
  if (cell.tensegrity) {
    checkTensegrity(*cell.tensegrity, check);
  } else {
    for (std::size_t i = 0; i < cell.layers.size(); ++i)
      checkMaterial(cell.layers[i], is_layered ? "cell/layers/" + std::to_string(i) + "/" : "cell/", check);
  }
  checkPuncture(cell.puncture, check);
  if (!cell.biomembrane) return;
  check.require(plausible::kLength, "cell/biomembrane/thickness", cell.biomembrane->thickness);
  check.require(plausible::kLength, "cell/biomembrane/dimple_radius", cell.biomembrane->dimple_radius);
}

void checkHoldingPipette(const Scene::HoldingPipette& pipette, PlausibleCheck& check) {
  if (!pipette.mouth)
    return check.require(plausible::kLength, "holding_pipette/contact_radius", pipette.contact_radius);
  const std::string path = "holding_pipette/mouth/";
  check.require(plausible::kLength, path + "inner_radius", pipette.mouth->inner_radius);
  check.require(plausible::kLength, path + "outer_radius", pipette.mouth->outer_radius);
  check.require(plausible::kTipRadius, path + "edge_radius", pipette.mouth->edge_radius);
  check.require(plausible::kSuction, path + "pressure", pipette.mouth->pressure);
}

}  // namespace

void checkPlausible(const Scene& scene) {
  PlausibleCheck check;
  checkCell(scene.cell, check);
  if (!scene.cell.tensegrity) checkHoldingPipette(scene.holding_pipette, check);
  const Scene::Needle& needle = scene.needle;
  check.require(plausible::kTipRadius, "needle/tip/radius", needle.tip.radius);
  check.requireGiven(plausible::kTipRadius, "needle/tip/edge_radius", needle.tip.edge_radius);
  if (needle.bore_radius) check.require(plausible::kTipRadius, "needle/bore_radius", *needle.bore_radius);
  check.require(plausible::kAdhesionEnergy, "needle/contact/adhesion/energy", needle.contact.adhesion_energy);
  check.requireGiven(plausible::kAdhesionRange, "needle/contact/adhesion/range", needle.contact.adhesion_range);
  for (const double offset : needle.offset) check.require(plausible::kDistance, "needle/offset", offset);
  if (scene.mesh.size) check.require(plausible::kLength, "mesh/size", *scene.mesh.size);
  check.throwAny();
}

}  // namespace microinjection
