#include "cell/scene.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "base/config_reader.h"
#include "base/errors.h"

namespace microinjection {
namespace {

const Range kPoisson = Range::open(-1, 0.5);

void readCell(ConfigReader cell, Scene::Cell& value) {
  cell.number("diameter", value.diameter, Range::positive(), ConfigReader::kRequired);
  ConfigReader material = cell.section("material", ConfigReader::kRequired);
  material.choice("model", value.material.model, materialModels(), ConfigReader::kRequired);
  material.number("young_modulus", value.material.young_modulus, Range::positive(), ConfigReader::kRequired);
  material.number("poisson_ratio", value.material.poisson_ratio, kPoisson, ConfigReader::kRequired);
  cell.section("puncture").number("force", value.puncture_force, Range::positive());
}

void readNeedle(ConfigReader needle, Scene::Needle& value) {
  ConfigReader tip = needle.section("tip", ConfigReader::kRequired);
  tip.choice("shape", value.tip.shape, {"disc"}, ConfigReader::kRequired);
  tip.number("radius", value.tip.radius, Range::positive(), ConfigReader::kRequired);
  Eigen::VectorXd offset = value.offset;
  needle.vector("offset", offset, Range::finite());
  value.offset = offset;
}

void readMesh(ConfigReader mesh, Scene::Mesh& value) {
  if (mesh.has("size")) {
    value.size = 0;
    mesh.number("size", *value.size, Range::positive());
  }
  ConfigReader refinement = mesh.section("refinement");
  refinement.number("zone", value.refinement.zone, Range::positive());
  refinement.number("density", value.refinement.density, {1, 100, false, false});
}

}  // namespace

double Scene::meshSize() const {
  if (mesh.size) return *mesh.size;
  return std::min(needle.tip.radius * mesh.refinement.density, 0.3 * cell.diameter);
}

void Scene::validate() const {
  std::vector<std::string> errors;
  const auto require = [&](bool good, const std::string& key, double value, const std::string& allowed) {
    std::ostringstream message;
    message << key << " = " << value << ": must be " << allowed;
    if (!good) errors.push_back(message.str());
  };
  const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
  try {
    cell.material.validate();
  } catch (const ConfigError& error) {
    errors.push_back(std::string("cell/") + error.what());
  }
  require(positive(cell.diameter), "cell/diameter", cell.diameter, "positive (m)");
  require(cell.puncture_force > 0, "cell/puncture/force", cell.puncture_force, "positive (N)");
  if (needle.tip.shape != "disc") errors.push_back("needle/tip/shape = " + needle.tip.shape + ": must be disc");
  // Beyond 0.95 of the radius the surface is so steep that a circle on it cannot be meshed well.
  std::ostringstream reach;
  reach << "in (0, 0.95) of the cell's radius " << radius() << " m";
  require(positive(holding_pipette.contact_radius) && holding_pipette.contact_radius < 0.95 * radius(),
          "holding_pipette/contact_radius", holding_pipette.contact_radius, reach.str());
  require(positive(needle.tip.radius) && needle.tip.radius < 0.95 * radius(), "needle/tip/radius", needle.tip.radius,
          reach.str());
  require(needle.offset.norm() + needle.tip.radius < 0.95 * radius(), "needle/offset (its length)",
          needle.offset.norm(), "with the tip's radius " + reach.str());
  require(meshSize() >= cell.diameter / 200 && meshSize() <= cell.diameter / 2, "mesh/size", meshSize(),
          "from 1/200 to half of the cell's diameter (m)");
  require(positive(mesh.refinement.zone), "mesh/refinement/zone", mesh.refinement.zone, "positive");
  require(mesh.refinement.density >= 1 && mesh.refinement.density <= 100, "mesh/refinement/density",
          mesh.refinement.density, "in [1, 100]");
  if (!errors.empty()) throw ConfigError(errors);
}

Scene parseScene(const YAML::Node& node, const std::string& origin) {
  Scene scene;
  ConfigReader reader(node, origin);
  readCell(reader.section("cell", ConfigReader::kRequired), scene.cell);
  reader.section("holding_pipette", ConfigReader::kRequired)
      .number("contact_radius", scene.holding_pipette.contact_radius, Range::positive(), ConfigReader::kRequired);
  readNeedle(reader.section("needle", ConfigReader::kRequired), scene.needle);
  readMesh(reader.section("mesh"), scene.mesh);
  reader.finish();
  try {
    scene.validate();
  } catch (const ConfigError& error) {
    throw ConfigError(origin + ": " + error.what());
  }
  return scene;
}

Scene loadScene(const std::string& path) { return parseScene(loadYamlMap(path), path); }

}  // namespace microinjection
