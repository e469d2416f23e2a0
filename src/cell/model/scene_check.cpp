#include "cell/model/scene_check.h"

#include <set>
#include <sstream>

#include "base/config_errors.h"
#include "base/errors.h"

namespace microinjection {
namespace {

constexpr double kRounding = 1e-9;  // relative

/// Largest distance of circles from the axis, over the cell's radius. Further out the surface is
/// too steep for a good mesh.
constexpr double kSharpest = 0.05;      // radius of the rounded edge, over the tip's radius
constexpr double kSteepestTaper = 0.3;  // rad
constexpr double kReach = 0.95;
constexpr double kWidestBore = 0.95;  // over the tip's radius

constexpr double kThinnestLayer = 1.0 / 500;  // over the cell's radius

std::string metres(double value) {
  std::ostringstream text;
  text << value << " m";
  return text.str();
}

void checkLayer(const Scene::Layer& layer, const std::string& path, ConfigErrors& errors) {
  try {
    layer.material.validate();
  } catch (const ConfigError& error) {
    std::istringstream lines(error.what());  // "material: KEY = ..."
    for (std::string line; std::getline(lines, line);) {
      const std::size_t colon = line.find(": ");
      errors.add(path + (line.compare(0, colon, "material") ? line : line.replace(colon, 2, "/")));
    }
  }
  errors.require(Range::nonNegative(), path + "surface_tension", layer.surface_tension, " N/m");
}

void checkLayers(const std::vector<Scene::Layer>& layers, ConfigErrors& errors) {
  std::set<std::string> names;
  const double radius = layers.front().outer_radius;
  const double thinnest = kThinnestLayer * radius;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const Scene::Layer& layer = layers[i];
    const std::string path = "cell/layers/" + std::to_string(i) + "/";
    checkLayer(layer, path, errors);
    errors.require(!layer.name.empty() && names.insert(layer.name).second, path + "name", layer.name, "",
                   "a name that no other layer has");
    errors.require(Range::positive(), path + "outer_radius", layer.outer_radius, " m");
    if (!Range::positive().contains(layer.outer_radius) || !Range::positive().contains(radius)) continue;
    const double inner = i + 1 < layers.size() ? layers[i + 1].outer_radius : 0;
    if (inner >= layer.outer_radius) {
      errors.add("cell/layers/" + std::to_string(i + 1) + "/outer_radius = " + metres(inner) + ": must be below the " +
                 metres(layer.outer_radius) + " of the layer around it (outermost first)");
    } else if (layer.outer_radius - inner < thinnest * (1 - kRounding)) {
      errors.add("cell/layers/" + std::to_string(i) + " (" + layer.name + ") is " + metres(layer.outer_radius - inner) +
                 " thick: must be at least 1/500 of the cell's radius, " + metres(thinnest));
    }
  }
}

void checkCell(const Scene::Cell& cell, ConfigErrors& errors) {
  if (cell.tensegrity) {
    for (const std::string& error : cell.tensegrity->errors()) errors.add("cell/" + error);
  } else if (cell.layers.size() == 1) {
    checkLayer(cell.layers.front(), "cell/", errors);
    errors.require(Range::positive(), "cell/diameter", cell.diameter(), " m");
  } else {
    checkLayers(cell.layers, errors);
  }
}

void checkTip(const Scene::Tip& tip, double cell_radius, ConfigErrors& errors) {
  errors.requireOneOf(tipShapes(), "needle/tip/shape", tip.shape);
  const double limit = tip.rounded() ? cell_radius * (1 + kRounding) : kReach * cell_radius;
  errors.require(
      Range{0, limit, true, false}.contains(tip.radius), "needle/tip/radius", tip.radius, " m",
      "above 0 and at most " + metres(limit) + (tip.rounded() ? ", the cell's radius" : ", 0.95 of the cell's radius"));
  if (tip.shape == "rounded_flat") {
    errors.require(tip.edge_radius >= kSharpest * tip.radius && tip.edge_radius <= tip.radius, "needle/tip/edge_radius",
                   tip.edge_radius, " m", "from 1/20 of the tip's radius to all of it, " + metres(tip.radius));
  } else {
    errors.require(tip.edge_radius == 0, "needle/tip/edge_radius", tip.edge_radius, " m",
                   "left out: it belongs to rounded_flat only");
  }
  errors.require(Range::closed(0, kSteepestTaper), "needle/tip/taper", tip.taper, " rad");
}

void checkAdhesion(const Scene::Needle& needle, ConfigErrors& errors) {
  const Scene::Contact& contact = needle.contact;
  const bool there = contact.adhesion_energy > 0;
  errors.require(Range::nonNegative(), "needle/contact/adhesion/energy", contact.adhesion_energy, " J/m^2");
  errors.require(!there || needle.tip.rounded(), "needle/contact/adhesion/energy", contact.adhesion_energy, " J/m^2",
                 "left out: a disc never parts from what it touches");
  errors.require(!there || Range::positive().contains(contact.adhesion_range), "needle/contact/adhesion/range",
                 contact.adhesion_range, " m", "above 0");
}

void checkBiomembrane(const Scene& scene, ConfigErrors& errors) {
  if (!scene.cell.biomembrane) return;
  const double dimple = scene.cell.biomembrane->dimple_radius, thickness = scene.cell.biomembrane->thickness;
  errors.require(Range::open(0, scene.radius()).contains(thickness), "cell/biomembrane/thickness", thickness, " m",
                 "above 0 and below the cell's radius, " + metres(scene.radius()));
  errors.require(dimple > scene.needle.tip.radius && dimple <= scene.radius(), "cell/biomembrane/dimple_radius", dimple,
                 " m", "above needle/tip/radius and at most the cell's radius, " + metres(scene.radius()));
}

void checkMouth(const Scene& scene, ConfigErrors& errors) {
  const Scene::Mouth& mouth = *scene.holding_pipette.mouth;
  const std::string path = "holding_pipette/mouth/";
  const double reach = kReach * scene.radius(), wall = mouth.outer_radius - mouth.inner_radius;
  errors.require(Range::positive(), path + "inner_radius", mouth.inner_radius, " m");
  errors.require(wall > 0, path + "outer_radius", mouth.outer_radius, " m",
                 "above the inner radius, " + metres(mouth.inner_radius));
  errors.require(mouth.edge_radius > 0 && mouth.edge_radius <= (1 + kRounding) * wall / 2, path + "edge_radius",
                 mouth.edge_radius, " m", "above 0 and at most half of the wall, " + metres(wall / 2));
  errors.require(
      mouth.inner_radius + mouth.edge_radius < reach, path + "inner_radius", mouth.inner_radius, " m",
      "with edge_radius below 0.95 of the cell's radius, " + metres(reach) + ": a wider mouth swallows the cell");
  errors.require(Range::finite(), path + "pressure", mouth.pressure, " Pa");
  errors.require(mouth.pressure <= 0, path + "pressure", mouth.pressure, " Pa",
                 "at most 0: pressure blows the cell off");
  errors.require(scene.needle.tip.rounded(), "needle/tip/shape", scene.needle.tip.shape, "",
                 "hemisphere or rounded_flat where suction holds the cell: the cell moves under the tip");
  errors.require(Range::nonNegative(), path + "contact/friction", mouth.contact.friction);
}

void checkNeedle(const Scene::Needle& needle, double cell_radius, ConfigErrors& errors) {
  checkTip(needle.tip, cell_radius, errors);
  const std::string& mode = needle.contact.mode;
  errors.require(mode == "sticking" || mode == "sliding", "needle/contact/mode", mode, "", "one of: sticking, sliding");
  errors.require(mode != "sliding" || needle.tip.rounded(), "needle/contact/mode", mode, "", kDiscSticks);
  const double widest = kWidestBore * needle.tip.radius;
  if (needle.bore_radius)
    errors.require(Range{0, widest, true, false}.contains(*needle.bore_radius), "needle/bore_radius",
                   *needle.bore_radius, " m", "above 0 and at most 0.95 of the tip's radius, " + metres(widest));
  errors.require(Range::nonNegative(), "needle/contact/friction", needle.contact.friction);
  errors.require(mode == "sliding" || needle.contact.friction == 0, "needle/contact/friction", needle.contact.friction,
                 "", "left out: it belongs to mode sliding only");
  checkAdhesion(needle, errors);
  const double reach = kReach * cell_radius, length = needle.offset.norm();
  if (needle.tip.rounded()) {
    errors.require(length < reach, "needle/offset (its length)", length, " m",
                   "below 0.95 of the cell's radius, " + metres(reach));
  } else {
    errors.require(length + needle.tip.radius < reach, "needle/offset (its length)", length, " m",
                   "with the tip's radius below 0.95 of the cell's radius, " + metres(reach));
  }
}

void checkMesh(const Scene& scene, ConfigErrors& errors) {
  const double diameter = scene.cell.diameter();
  errors.require(scene.meshSize() >= diameter / 200 && scene.meshSize() <= diameter / 2, "mesh/size", scene.meshSize(),
                 " m", "from 1/200 to half of the cell's diameter, " + metres(diameter));
  const Scene::Refinement& refinement = scene.mesh.refinement;
  errors.require(Range::positive(), "mesh/refinement/zone", refinement.zone);
  errors.require(Range::closed(1, 100), "mesh/refinement/density", refinement.density);
  errors.require(Range::closed(1, 4), "mesh/stretch", scene.mesh.stretch);
}

}  // namespace

void checkScene(const Scene& scene) {
  if (scene.cell.layers.empty()) throw ConfigError("cell/layers: must have at least one layer");
  ConfigErrors errors;
  checkCell(scene.cell, errors);
  scene.cell.puncture.check(scene.needle.tip.radius, errors);
  errors.require(scene.needle.tip.taper == 0 || scene.cell.puncture.toughLayers() > 0, "needle/tip/taper",
                 scene.needle.tip.taper, " rad", "left out: it is felt in a cell with cell/puncture/toughness only");
  const double contact_radius = scene.holding_pipette.contact_radius;
  const double reach = kReach * scene.radius();
  if (scene.cell.tensegrity) {
    errors.require(!scene.needle.tip.rounded(), "needle/tip/shape", scene.needle.tip.shape, "",
                   "disc: a tensegrity cell's membrane sticks to a flat tip");
    if (scene.cell.biomembrane) {
      errors.add("cell/biomembrane: must be left out of a tensegrity cell, which has the membrane of its own");
    }
    checkNeedle(scene.needle, scene.radius(), errors);
    return errors.throwAny();
  }
  errors.require(Range::open(0, reach).contains(contact_radius), "holding_pipette/contact_radius", contact_radius, " m",
                 "above 0 and below 0.95 of the cell's radius, " + metres(reach));
  if (scene.holding_pipette.mouth) checkMouth(scene, errors);
  checkNeedle(scene.needle, scene.radius(), errors);
  checkBiomembrane(scene, errors);
  checkMesh(scene, errors);
  errors.throwAny();
}

}  // namespace microinjection
