#include "cell/family/family.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/config_reader.h"
#include "base/errors.h"
#include "cell/family/family_places.h"
#include "cell/material/material_parameter.h"
#include "cell/model/plausible_scene.h"
#include "cell/model/scene_description.h"
#include "cell/model/similarity.h"

namespace microinjection {
namespace {

constexpr double kRoundingOfRange = 1e-9;
constexpr double kDepthExponent = 2.5;  ///< of the depth as a function of the tip's radius

void addMisfit(std::string& text, const std::string& misfit) { text += (text.empty() ? "" : ", ") + misfit; }

}  // namespace

std::vector<Family::Parameter> readFamilyParameters(ConfigReader& file, const std::string& key, int layers,
                                                    const std::vector<Ratio>& table) {
  std::vector<Family::Parameter> parameters;
  ConfigReader reader = file.section(key);
  for (const Ratio& ratio : table) {
    if (!reader.has(ratio.name)) continue;
    Eigen::VectorXd borders = Eigen::Vector2d::Zero();
    reader.vector(ratio.name, borders, ratio.logarithmic ? Range::positive() : Range::nonNegative());
    if (!(borders[0] < borders[1])) reader.error(ratio.name, "must be [low, high] with low < high");
    if (layers < ratio.layers) reader.error(ratio.name, "must be left out: the scene's cell has one layer");
    parameters.push_back({&ratio, borders[0], borders[1]});
  }
  return parameters;
}

std::string Family::Parameter::text(double value) const {
  std::ostringstream out;
  out.precision(3);
  out << ratio->name << ' ' << value << " of [" << low << ", " << high << ']';
  return out.str();
}

double Family::Parameter::coordinate(double value) const {
  if (!ratio->logarithmic) return (2 * value - low - high) / (high - low);
  return std::log(value * value / (low * high)) / std::log(high / low);
}

double Family::Parameter::value(double coordinate) const {
  if (!ratio->logarithmic) return 0.5 * (low + high) + 0.5 * coordinate * (high - low);
  return std::sqrt(low * high) * std::pow(high / low, 0.5 * coordinate);
}

Family Family::load(const std::string& path) {
  Family family;
  ConfigReader reader = ConfigReader::ofFile(path);
  const YAML::Node scene = reader.any("scene");  // has a reader of its own
  reader.text("name", family.name_, ConfigReader::kRequired);
  if (!scene) reader.error("scene", "is missing");
  ConfigReader range = reader.section("range", ConfigReader::kRequired);
  range.number("angle", family.angle_, Range{0, 1.2, true, false}, ConfigReader::kRequired);
  range.number("deepest", family.deepest_, Range{0, 1, true, false}, ConfigReader::kRequired);
  range.number("half_depth_tip", family.half_depth_tip_, Range::positive(), ConfigReader::kRequired);
  if (scene) family.scene_ = withoutDimension(parseDimensionlessScene(scene, path + ": scene"));
  const int layers = static_cast<int>(family.scene_.cell.layers.size());
  family.parameters_ = readFamilyParameters(reader, "parameters", layers, ratios());
  family.constants_ = readFamilyParameters(reader, "constants", layers, ratios());
  if (family.parameters_.empty()) reader.error("parameters", "must name at least one ratio");
  reader.finish();
  SurrogatePlan::check(family.scene_);
  return family;
}

Scene Family::member(const Eigen::VectorXd& coordinates) const {
  Scene scene = scene_;
  for (int i = 0; i < dimension(); ++i) parameters_[i].ratio->set(scene, parameters_[i].value(coordinates[i]));
  return scene;
}

/// Reads a ratio of `scene` and gives the scene the family's own.
std::optional<double> Family::takeRatio(const Ratio& ratio, Scene& scene) const {
  const double value = ratio.get(scene);
  Scene same = scene;
  ratio.set(same, value);
  if (describeCellAndTip(same) != describeCellAndTip(scene)) return std::nullopt;  // not that of all layers
  ratio.set(scene, ratio.get(scene_));
  return value;
}

std::optional<Eigen::VectorXd> Family::coordinatesOf(const Scene& scene, std::string* misfit) const {
  std::string text;
  const auto coordinates = coordinatesOf(scene, text);
  if (misfit) *misfit = text;
  return coordinates;
}

std::optional<Eigen::VectorXd> Family::coordinatesOf(const Scene& scene, std::string& misfit) const {
  if (scene.cell.tensegrity) {
    misfit = "the cell is a tensegrity";
    return std::nullopt;
  }
  if (const std::size_t count = scene_.cell.layers.size(); scene.cell.layers.size() != count) {
    misfit = std::to_string(scene.cell.layers.size()) +
             (scene.cell.layers.size() == 1 ? " layer, not " : " layers, not ") + std::to_string(count);
    return std::nullopt;
  }
  Scene other = withoutDimension(SurrogatePlan::elastic(scene));
  Eigen::VectorXd coordinates(dimension());
  for (int i = 0; i < dimension(); ++i) {
    const Ratio& ratio = *parameters_[i].ratio;
    const std::optional<double> value = takeRatio(ratio, other);
    if (!value) return addMisfit(misfit, ratio.name + std::string(" is not the same in all layers")), std::nullopt;
    if (ratio.logarithmic && !(*value > 0)) return addMisfit(misfit, ratio.name + std::string(" is 0")), std::nullopt;
    coordinates[i] = parameters_[i].coordinate(*value);
  }
  for (const Parameter& constant : constants_) {
    const std::optional<double> value = takeRatio(*constant.ratio, other);
    if (!value)
      addMisfit(misfit, constant.ratio->name + std::string(" is not the same in all layers"));
    else if (*value < constant.low || *value > constant.high)
      addMisfit(misfit, constant.text(*value));
  }
  if (misfit.empty()) misfit = differenceFrom(other);
  // The ratios do not hold what no surrogate has, such as adhesion.
  try {
    if (misfit.empty()) SurrogatePlan::check(scene);
  } catch (const ConfigError& error) {
    misfit = error.what();
  }
  return misfit.empty() ? std::optional(coordinates) : std::nullopt;
}

/// What the family does not vary and a scene without dimension has otherwise; empty if there is nothing.
std::string Family::differenceFrom(const Scene& scene) const {
  const Scene own = SurrogatePlan::elastic(scene_);
  if (describeCellAndTip(scene) == describeCellAndTip(own)) return "";
  std::string text;
  const auto compare = [&](const std::string& name, const auto& value, const auto& wanted) {
    std::ostringstream out;
    out.precision(3);
    out << name << ' ' << value << ", not " << wanted;
    if (value != wanted) addMisfit(text, out.str());
  };
  for (std::size_t i = 0; i < own.cell.layers.size(); ++i) {
    const Scene::Layer &layer = scene.cell.layers[i], &wanted = own.cell.layers[i];
    const std::string of = own.cell.layers.size() > 1 ? " of layer " + std::to_string(i) : "";
    compare("material" + of, layer.material.model, wanted.material.model);
    for (const MaterialParameter& each : materialParameters()) {
      if (each.stresses == 0) compare(each.name + of, layer.material.*each.value, wanted.material.*each.value);
    }
    compare("surface_tension" + of, layer.surface_tension, wanted.surface_tension);
  }
  compare("tip", scene.needle.tip.shape, own.needle.tip.shape);
  compare("contact", scene.needle.contact.mode, own.needle.contact.mode);
  compare("friction", scene.needle.contact.friction, own.needle.contact.friction);
  compare("holding_radius", scene.holding_pipette.contact_radius, own.holding_pipette.contact_radius);
  compare("tip_radius", scene.needle.tip.radius, own.needle.tip.radius);
  return text.empty() ? "the cell or the tip is of another kind" : text;
}

bool Family::contains(const Eigen::VectorXd& coordinates) {
  return coordinates.cwiseAbs().maxCoeff() <= 1 + kRoundingOfRange;
}

SurrogateRange Family::range(const Scene& member) const {
  const double depth =
      rounded(deepest_ / (1 + std::pow(half_depth_tip_ / member.needle.tip.radius, kDepthExponent)) * member.radius());
  return familyRange(angle_, depth);
}

std::string Family::description() const {
  std::ostringstream out;
  out << std::hexfloat << "family " << name_ << " of ";
  for (const Parameter& parameter : parameters_) {
    out << parameter.ratio->name << ' ' << parameter.low << ' ' << parameter.high << ' ';
  }
  const Scene centre = member(Eigen::VectorXd::Zero(dimension()));
  out << "range " << deepest_ << ' ' << half_depth_tip_ << ' '
      << SurrogatePlan::plan(centre, range(centre)).description(centre);
  return out.str();
}

}  // namespace microinjection
