#include "cell/model/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/config_reader.h"
#include "base/errors.h"
#include "base/parse_number.h"
#include "cell/contact/pipette_mouth.h"
#include "cell/material/material_parameter.h"
#include "cell/model/plausible_scene.h"
#include "cell/model/read_quantity.h"
#include "cell/model/scene_check.h"
#include "cell/model/tensegrity_scene.h"

namespace microinjection {
namespace {

constexpr char kContinuum[] = "continuum", kTensegrity[] = "tensegrity";
constexpr double kAgreement = 1e-6;  // largest relative difference of a diameter that is given twice

void readViscoelasticity(ConfigReader reader, ViscoelasticityConfig& value) {
  for (ConfigReader& term_reader : reader.sections("prony")) {
    PronyTerm& term = value.prony.emplace_back();
    readQuantity(term_reader, "modulus_ratio", term.modulus_ratio, Range::positive(), "", ConfigReader::kRequired);
    readQuantity(term_reader, "relaxation_time", term.relaxation_time, Range::positive(), "s", ConfigReader::kRequired);
  }
  readQuantity(reader, "viscosity", value.viscosity, Range::nonNegative(), "Pa s");
}

void readMaterial(ConfigReader reader, MaterialConfig& value) {
  value.model.clear();  // empty unless it is read
  reader.choice("model", value.model, materialModels(), ConfigReader::kRequired);
  for (const MaterialParameter& each : materialParameters()) {
    const auto presence = each.ofAllModels() ? ConfigReader::kRequired : ConfigReader::kOptional;
    readQuantity(reader, each.name, value.*each.value, each.allowed, each.unit, presence);
    if (!each.ofAllModels() && reader.has(each.name) && !value.model.empty() && value.model != each.model)
      reader.error(each.name, std::string("must be left out: it belongs to model ") + each.model + " only");
  }
  readViscoelasticity(reader.section("viscoelasticity"), value.viscoelasticity);
}

void readSurfaceTension(ConfigReader reader, Scene::Layer& value) {
  readQuantity(reader, "surface_tension", value.surface_tension, Range::nonNegative(), "N/m");
}

void readLayers(ConfigReader cell, std::vector<Scene::Layer>& layers) {
  layers.clear();
  for (ConfigReader& reader : cell.sections("layers", ConfigReader::kRequired)) {
    Scene::Layer& layer = layers.emplace_back();
    layer.outer_radius = std::numeric_limits<double>::quiet_NaN();  // NaN unless it is read
    reader.text("name", layer.name, ConfigReader::kRequired);
    readQuantity(reader, "outer_radius", layer.outer_radius, Range::positive(), "m", ConfigReader::kRequired);
    readMaterial(reader.section("material", ConfigReader::kRequired), layer.material);
    readSurfaceTension(reader, layer);
  }
  if (layers.empty()) cell.error("layers", "must have at least one layer");
}

void readLayeredCell(ConfigReader cell, Scene::Cell& value) {
  readLayers(cell, value.layers);
  Scene::Layer refused;
  if (cell.has("material")) {
    readMaterial(cell.section("material"), refused.material);
    cell.error("material", "must be left out where there are layers: each has its own");
  }
  if (cell.has("surface_tension")) {
    readSurfaceTension(cell, refused);
    cell.error("surface_tension", "must be left out where there are layers: each has its own");
  }
  double diameter = std::numeric_limits<double>::quiet_NaN();
  readQuantity(cell, "diameter", diameter, Range::positive(), "m");
  const double outer_radius = value.layers.empty() ? diameter : value.layers.front().outer_radius;
  if (std::abs(diameter - 2 * outer_radius) > kAgreement * diameter) {
    std::ostringstream message;
    message << "must be twice cell/layers/0/outer_radius = " << outer_radius << " m, or left out";
    cell.error("diameter", message.str());
  }
}

void readHomogeneousCell(ConfigReader cell, Scene::Cell& value) {
  Scene::Layer& layer = value.layers.front();
  double diameter = value.diameter();
  readQuantity(cell, "diameter", diameter, Range::positive(), "m", ConfigReader::kRequired);
  layer.outer_radius = diameter / 2;
  if (!cell.has("material")) cell.error("material", "is missing; or give layers");
  readMaterial(cell.section("material"), layer.material);
  readSurfaceTension(cell, layer);
}

void readCell(ConfigReader cell, Scene::Cell& value) {
  std::string model = kContinuum;
  cell.choice("model", model, {kContinuum, kTensegrity});
  if (model == kTensegrity) {
    readTensegrity(cell, value.tensegrity.emplace());
    value.layers.front().outer_radius = value.tensegrity->radius;
  } else {
    cell.has("layers") ? readLayeredCell(cell, value) : readHomogeneousCell(cell, value);
  }
  value.puncture.read(cell.section("puncture"));
  if (!cell.has("biomembrane")) return;
  ConfigReader biomembrane = cell.section("biomembrane");
  value.biomembrane.emplace();
  readQuantity(biomembrane, "thickness", value.biomembrane->thickness, Range::positive(), "m", ConfigReader::kRequired);
  readQuantity(biomembrane, "dimple_radius", value.biomembrane->dimple_radius, Range::positive(), "m",
               ConfigReader::kRequired);
}

void readAdhesion(ConfigReader contact, Scene::Contact& value) {
  if (!contact.has("adhesion")) return;
  ConfigReader adhesion = contact.section("adhesion");
  readQuantity(adhesion, "energy", value.adhesion_energy, Range::positive(), "J/m^2", ConfigReader::kRequired);
  readQuantity(adhesion, "range", value.adhesion_range, Range::positive(), "m", ConfigReader::kRequired);
}

void readContact(ConfigReader& contact, Scene::Contact& value) {
  if (contact.has("mode")) value.mode.clear();  // empty unless it is read
  contact.choice("mode", value.mode, {"sticking", "sliding"});
  readQuantity(contact, "friction", value.friction, Range::nonNegative(), "");
  if (value.mode == "sticking" && contact.has("friction")) {
    contact.error("friction", "must be left out: it belongs to mode sliding only");
  }
  readAdhesion(contact, value);
}

void readMouth(ConfigReader mouth, Scene::Mouth& value) {
  readQuantity(mouth, "inner_radius", value.inner_radius, Range::positive(), "m", ConfigReader::kRequired);
  readQuantity(mouth, "outer_radius", value.outer_radius, Range::positive(), "m", ConfigReader::kRequired);
  readQuantity(mouth, "edge_radius", value.edge_radius, Range::positive(), "m", ConfigReader::kRequired);
  readQuantity(mouth, "pressure", value.pressure, Range::finite(), "Pa", ConfigReader::kRequired);
  ConfigReader contact = mouth.section("contact");
  readContact(contact, value.contact);
}

void readHoldingPipette(ConfigReader pipette, Scene::HoldingPipette& value, bool required) {
  if (!pipette.has("mouth")) {
    readQuantity(pipette, "contact_radius", value.contact_radius, Range::positive(), "m",
                 required ? ConfigReader::kRequired : ConfigReader::kOptional);
    return;
  }
  readMouth(pipette.section("mouth"), value.mouth.emplace());
  value.contact_radius = value.mouth->inner_radius + value.mouth->edge_radius;
  if (pipette.has("contact_radius"))
    pipette.error("contact_radius", "must be left out: suction holds the cell at the mouth that is given");
}

void readNeedle(ConfigReader needle, Scene::Needle& value) {
  ConfigReader tip = needle.section("tip", ConfigReader::kRequired);
  value.tip.shape.clear();  // empty unless it is read
  tip.choice("shape", value.tip.shape, tipShapes(), ConfigReader::kRequired);
  readQuantity(tip, "radius", value.tip.radius, Range::positive(), "m", ConfigReader::kRequired);
  const bool has_edge = value.tip.shape == "rounded_flat";
  readQuantity(tip, "edge_radius", value.tip.edge_radius, Range::positive(), "m",
               has_edge ? ConfigReader::kRequired : ConfigReader::kOptional);
  if (!has_edge && !value.tip.shape.empty() && tip.has("edge_radius")) {
    tip.error("edge_radius", "must be left out: it belongs to shape rounded_flat only");
  }
  readQuantity(tip, "taper", value.tip.taper, Range::nonNegative(), "rad");
  if (needle.has("bore_radius"))
    readQuantity(needle, "bore_radius", value.bore_radius.emplace(), Range::positive(), "m");
  ConfigReader contact = needle.section("contact");
  readContact(contact, value.contact);
  if (value.contact.mode == "sliding" && value.tip.shape == "disc") {
    contact.error("mode", std::string("must be ") + kDiscSticks);
  }
  Eigen::VectorXd offset = value.offset;
  needle.vector("offset", offset, Range::finite());
  value.offset = offset;
}

void readMesh(ConfigReader mesh, Scene::Mesh& value) {
  if (mesh.has("size")) {
    value.size = 0;
    readQuantity(mesh, "size", *value.size, Range::positive(), "m");
  }
  ConfigReader refinement = mesh.section("refinement");
  readQuantity(refinement, "zone", value.refinement.zone, Range::positive(), "needle diameters");
  readQuantity(refinement, "density", value.refinement.density, {1, 100, false, false}, "");
  readQuantity(mesh, "stretch", value.stretch, Range::closed(1, 4), "");
}

void readRequirements(ConfigReader requirements, Scene::Requirements& value) {
  readQuantity(requirements, "force_error", value.force_error, Range::positive(), "relative");
  readQuantity(requirements, "rate", value.rate, Range::positive(), "Hz");
}

Scene readScene(const YAML::Node& node, const std::string& origin) {
  Scene scene;
  ConfigReader reader(node, origin);
  readCell(reader.section("cell", ConfigReader::kRequired), scene.cell);
  const bool continuum = !scene.cell.tensegrity;
  if (!continuum && reader.has("holding_pipette")) {
    reader.error("holding_pipette", "must be left out: of a tensegrity cell the three lowest strut ends are held");
  }
  if (!continuum && reader.has("mesh")) {
    reader.error("mesh", "must be left out: a tensegrity cell has microtubules/slices and membrane/divisions");
  }
  if (!continuum && reader.has("requirements")) {
    reader.error("requirements", "must be left out: a tensegrity cell has one model, whose error is not known");
  }
  readHoldingPipette(reader.section("holding_pipette", continuum ? ConfigReader::kRequired : ConfigReader::kOptional),
                     scene.holding_pipette, continuum);
  readNeedle(reader.section("needle", ConfigReader::kRequired), scene.needle);
  readMesh(reader.section("mesh"), scene.mesh);
  readRequirements(reader.section("requirements"), scene.requirements);
  reader.finish();
  return scene;
}

/// Runs a check of a scene, whose messages begin with keys; those that it throws begin with `origin`.
void checkFrom(const std::string& origin, const Scene& scene, void (*check)(const Scene& scene)) {
  try {
    check(scene);
  } catch (const ConfigError& error) {
    std::vector<std::string> messages;
    std::istringstream lines(error.what());
    for (std::string line; std::getline(lines, line);) messages.push_back(origin + ": " + line);
    throw ConfigError(messages);
  }
}

/// Line of the value whose path begins `text`, as "cell/layers/0/name = zona: must be"; of the nearest map around it
/// where it is not in the file.
int lineOf(const YAML::Node& file, const std::string& text) {
  YAML::Node at;
  at.reset(file);
  int line = file.Mark().line;
  std::istringstream keys(text.substr(0, text.find_first_of(" :")));
  for (std::string key; std::getline(keys, key, '/');) {
    YAML::Node next;
    if (at.IsMap()) {
      for (const auto& item : at) {
        if (!item.first.IsScalar() || item.first.Scalar() != key) continue;
        line = item.first.Mark().line;
        next.reset(item.second);
      }
    } else if (const auto index = parseNumber<std::size_t>(key); at.IsSequence() && index && *index < at.size()) {
      next.reset(at[*index]);
      line = next.Mark().line;
    }
    at.reset(next);
  }
  return line + 1;
}

/// "FILE: KEY ..." becomes "FILE, line N: KEY ...".
ConfigError withLines(const ConfigError& error, const YAML::Node& file, const std::string& path) {
  std::vector<std::string> messages;
  std::istringstream lines(error.what());
  for (std::string line; std::getline(lines, line);) {
    const std::string start = path + ": ";
    if (line.rfind(start, 0) == 0) {
      const std::string text = line.substr(start.size());
      line = path + ", line " + std::to_string(lineOf(file, text)) + ": " + text;
    }
    messages.push_back(line);
  }
  return ConfigError(messages);
}

}  // namespace

std::vector<double> Scene::Cell::outerRadii() const {
  std::vector<double> radii;
  for (const Layer& layer : layers) radii.push_back(layer.outer_radius);
  return radii;
}

std::vector<std::shared_ptr<const Material>> Scene::Cell::makeMaterials() const {
  std::vector<std::shared_ptr<const Material>> materials;
  for (const Layer& layer : layers) materials.push_back(makeMaterial(layer.material));
  return materials;
}

double Scene::meshSize() const {
  if (mesh.size) return *mesh.size;
  const double wanted = needle.tip.radius * mesh.refinement.density;
  return std::min(std::max(wanted, 0.05 * cell.diameter()), 0.3 * cell.diameter());
}

const std::vector<std::string>& tipShapes() {
  static const std::vector<std::string> shapes = {"disc", "hemisphere", "rounded_flat"};
  return shapes;
}

void Scene::validate() const { checkScene(*this); }

void Scene::requireContinuum(const std::string& purpose) const {
  if (cell.tensegrity) throw ConfigError("cell/model = tensegrity: must be continuum for " + purpose);
}

void Scene::requireGlued(const std::string& purpose) const {
  if (holding_pipette.mouth)
    throw ConfigError("holding_pipette/mouth: must be left out for " + purpose + "; give contact_radius instead");
}

Scene Scene::glued() const {
  Scene result = *this;
  if (const std::optional<Mouth>& mouth = holding_pipette.mouth) {
    const PipetteMouth lip(mouth->inner_radius, mouth->outer_radius, mouth->edge_radius, -1);
    result.holding_pipette.contact_radius = lip.touchRadius(radius());
    result.holding_pipette.mouth.reset();
  }
  return result;
}

Scene parseScene(const YAML::Node& node, const std::string& origin) {
  const Scene scene = readScene(node, origin);
  checkFrom(origin, scene, checkPlausible);
  checkFrom(origin, scene, checkScene);
  return scene;
}

Scene parseDimensionlessScene(const YAML::Node& node, const std::string& origin) {
  const Scene scene = readScene(node, origin);
  checkFrom(origin, scene, checkScene);
  return scene;
}

Scene loadScene(const std::string& path) {
  const YAML::Node file = loadYamlMap(path);
  try {
    return parseScene(file, path);
  } catch (const ConfigError& error) {
    throw withLines(error, file, path);
  }
}

}  // namespace microinjection
