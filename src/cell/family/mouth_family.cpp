#include "cell/family/mouth_family.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/config_reader.h"
#include "base/errors.h"
#include "cell/model/plausible_scene.h"
#include "cell/model/scene_description.h"
#include "cell/model/similarity.h"
#include "cell/surrogate/surrogate_plan.h"

namespace microinjection {
namespace {

constexpr double kRoundingOfRatio = 1e-9;
constexpr char kTongueKey[] = "tongue", kHeldForceKey[] = "held_force";

bool isWall(const Family::Parameter& parameter) { return parameter.ratio->name == std::string("wall"); }

bool hasOnePoissonRatio(const Scene& scene) {
  return std::all_of(scene.cell.layers.begin(), scene.cell.layers.end(), [&](const Scene::Layer& layer) {
    return layer.material.poisson_ratio == scene.cell.material().poisson_ratio;
  });
}

}  // namespace

std::optional<MouthFamily::Kind> MouthFamily::kindOf(const std::string& path) {
  const ConfigReader reader = ConfigReader::ofFile(path);
  if (reader.has(kTongueKey)) return Kind::kTongue;
  if (reader.has(kHeldForceKey)) return Kind::kHeldForce;
  return std::nullopt;
}

MouthFamily MouthFamily::load(const std::string& path) {
  MouthFamily family;
  ConfigReader reader = ConfigReader::ofFile(path);
  family.kind_ = reader.has(kHeldForceKey) ? Kind::kHeldForce : Kind::kTongue;
  reader.text(family.kind_ == Kind::kTongue ? kTongueKey : kHeldForceKey, family.name_, ConfigReader::kRequired);
  const YAML::Node scene = reader.any("scene");  // has a reader of its own
  if (!scene) reader.error("scene", "is missing");
  if (scene) family.scene_ = withoutDimension(parseDimensionlessScene(scene, path + ": scene"));
  const int layers = static_cast<int>(family.scene_.cell.layers.size());
  family.parameters_ = readFamilyParameters(reader, "parameters", layers, mouthRatios());
  family.constants_ = readFamilyParameters(reader, "constants", layers, mouthRatios());
  if (family.parameters_.empty()) reader.error("parameters", "must name at least one ratio");
  if (scene) family.checkMouth(reader);
  reader.finish();
  return family;
}

/// Radii would differ in rounding if they were not all set.
void MouthFamily::checkMouth(ConfigReader& reader) const {
  if (!scene_.holding_pipette.mouth) reader.error("scene/holding_pipette/mouth", "is missing");
  for (const char* name : {"bore_radius", "lip_edge", "wall"}) {
    const auto isNamed = [&](const Family::Parameter& each) { return each.ratio->name == std::string(name); };
    if (std::none_of(parameters_.begin(), parameters_.end(), isNamed) &&
        std::none_of(constants_.begin(), constants_.end(), isNamed))
      reader.error("parameters", std::string("must name ") + name + ", or `constants` must");
  }
}

Scene MouthFamily::member(const Eigen::VectorXd& coordinates) const {
  Scene scene = scene_;
  for (int i = 0; i < dimension(); ++i) parameters_[i].ratio->set(scene, parameters_[i].value(coordinates[i]));
  scene.holding_pipette.contact_radius = scene.holding_pipette.mouth->inner_radius;
  return scene;
}

std::optional<Eigen::VectorXd> MouthFamily::coordinatesOf(const Scene& scene, std::string* misfit) const {
  Eigen::VectorXd coordinates(dimension());
  const std::string text = misfitOf(scene, coordinates);
  if (misfit) *misfit = text;
  return text.empty() ? std::optional(coordinates) : std::nullopt;
}

std::string MouthFamily::misfitOf(const Scene& scene, Eigen::VectorXd& coordinates) const {
  if (scene.cell.tensegrity) return "the cell is a tensegrity";
  if (!scene.holding_pipette.mouth) return "holding_pipette has no mouth";
  if (scene.cell.layers.size() != scene_.cell.layers.size())
    return "layers: " + std::to_string(scene.cell.layers.size()) + ", not " + std::to_string(scene_.cell.layers.size());
  if (!hasOnePoissonRatio(scene)) return "poisson_ratio is not the same in all layers";
  Scene other = withoutDimension(SurrogatePlan::elastic(scene)), own = scene_;
  for (int i = 0; i < dimension(); ++i) {
    const Family::Parameter& each = parameters_[i];
    const double value = each.ratio->get(other);
    coordinates[i] = each.coordinate(isWall(each) ? std::min(value, each.high) : value);
  }
  for (const Family::Parameter& constant : constants_) {
    const double value = constant.ratio->get(other);
    if (value < constant.low || (value > constant.high && !isWall(constant))) return constant.text(value);
  }
  // What is left has to be the same.
  other.holding_pipette.contact_radius = own.holding_pipette.contact_radius;
  if (kind_ == Kind::kTongue) {
    other.needle = own.needle;
    other.holding_pipette.mouth->pressure = own.holding_pipette.mouth->pressure;
  }
  for (const std::vector<Family::Parameter>& group : {parameters_, constants_}) {
    for (const Family::Parameter& each : group) {
      const double value = each.ratio->get(scene_);
      each.ratio->set(other, value);
      each.ratio->set(own, value);
    }
  }
  if (describeCellAndTip(other) == describeCellAndTip(own)) return "";
  return "material, tension, tip or a contact is of another kind than the family's";
}

std::string MouthFamily::refusal(const Eigen::VectorXd& coordinates) const {
  std::ostringstream out;
  for (int i = 0; i < dimension(); ++i) {
    if (std::abs(coordinates[i]) <= 1 + kRoundingOfRatio) continue;
    const Family::Parameter& each = parameters_[i];
    out << (out.str().empty() ? "" : "; ") << each.ratio->name << " = " << each.value(coordinates[i])
        << ": must be from " << each.low << " to " << each.high;
  }
  return out.str();
}

std::string MouthFamily::description() const {
  std::ostringstream out;
  out << std::hexfloat << (kind_ == Kind::kTongue ? "tongue family " : "held force family ") << name_ << " of ";
  for (const Family::Parameter& parameter : parameters_)
    out << parameter.ratio->name << ' ' << parameter.low << ' ' << parameter.high << ' ';
  out << describeCellAndTip(member(Eigen::VectorXd::Zero(dimension())));
  return out.str();
}

}  // namespace microinjection
