#include "cell/family/section_family.h"

#include <algorithm>
#include <cmath>
#include <iterator>
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

struct KindOfSections {
  SectionFamily::Kind kind;
  const char *key, *text;           ///< of its files, of its data
  std::vector<std::string> ratios;  ///< of what a needle does, that it must name
};
const KindOfSections kKindsOfSections[] = {
    {SectionFamily::Kind::kTongue, "tongue", "tongue family ", {}},
    {SectionFamily::Kind::kHeldForce, "held_force", "held force family ", {}},
    {SectionFamily::Kind::kFrictionForce, "friction_force", "friction force family ", {"friction"}},
    {SectionFamily::Kind::kWithdrawal,
     "withdrawal",
     "withdrawal family ",
     {"friction", "adhesion_root", "adhesion_range"}},
    {SectionFamily::Kind::kPierced, "pierced", "pierced family ", {"toughness"}}};

const KindOfSections& factsOf(SectionFamily::Kind kind) {
  return *std::find_if(std::begin(kKindsOfSections), std::end(kKindsOfSections),
                       [kind](const KindOfSections& each) { return each.kind == kind; });
}

/// Larger ones make no difference any more.
bool saturates(const Family::Parameter& parameter) {
  const std::string name = parameter.ratio->name;
  return name == "wall" || name == "friction";
}

bool hasOnePoissonRatio(const Scene& scene) {
  return std::all_of(scene.cell.layers.begin(), scene.cell.layers.end(), [&](const Scene::Layer& layer) {
    return layer.material.poisson_ratio == scene.cell.material().poisson_ratio;
  });
}

}  // namespace

std::optional<SectionFamily::Kind> SectionFamily::kindOf(const std::string& path) {
  const ConfigReader reader = ConfigReader::ofFile(path);
  for (const KindOfSections& each : kKindsOfSections) {
    if (reader.has(each.key)) return each.kind;
  }
  return std::nullopt;
}

SectionFamily SectionFamily::load(const std::string& path) {
  SectionFamily family;
  ConfigReader reader = ConfigReader::ofFile(path);
  family.kind_ = kindOf(path).value_or(Kind::kTongue);
  reader.text(factsOf(family.kind_).key, family.name_, ConfigReader::kRequired);
  const YAML::Node scene = reader.any("scene");  // has a reader of its own
  if (!scene) reader.error("scene", "is missing");
  if (scene) family.scene_ = withoutDimension(parseDimensionlessScene(scene, path + ": scene"));
  const int layers = static_cast<int>(family.scene_.cell.layers.size());
  const std::vector<Ratio>& ratios = family.hasMouth() ? mouthRatios() : needleRatios();
  family.parameters_ = readFamilyParameters(reader, "parameters", layers, ratios);
  family.constants_ = readFamilyParameters(reader, "constants", layers, ratios);
  if (family.parameters_.empty()) reader.error("parameters", "must name at least one ratio");
  if (scene && family.hasMouth()) family.checkMouth(reader);
  if (scene && !family.hasMouth()) {
    if (const std::string misfit = family.formMisfit(family.scene_); !misfit.empty()) reader.error("scene", misfit);
    const std::vector<std::string>& own = factsOf(family.kind_).ratios;
    for (const char* ratio : {"friction", "toughness", "adhesion_root", "adhesion_range"}) {
      const bool is_own = std::find(own.begin(), own.end(), ratio) != own.end();
      if (is_own && !family.names(ratio)) reader.error("parameters", std::string("must name ") + ratio);
      if (!is_own && family.names(ratio))
        reader.error("parameters", std::string(ratio) + " belongs to another kind of family");
    }
  }
  reader.finish();
  return family;
}

bool SectionFamily::names(const std::string& ratio) const {
  const auto is = [&](const Family::Parameter& each) { return each.ratio->name == ratio; };
  return std::any_of(parameters_.begin(), parameters_.end(), is) ||
         std::any_of(constants_.begin(), constants_.end(), is);
}

/// Radii would differ in rounding if they were not all set.
void SectionFamily::checkMouth(ConfigReader& reader) const {
  if (!scene_.holding_pipette.mouth) reader.error("scene/holding_pipette/mouth", "is missing");
  for (const char* name : {"bore_radius", "lip_edge", "wall"}) {
    if (!names(name)) reader.error("parameters", std::string("must name ") + name + ", or `constants` must");
  }
}

Scene SectionFamily::member(const Eigen::VectorXd& coordinates) const {
  Scene scene = scene_;
  for (int i = 0; i < dimension(); ++i) parameters_[i].ratio->set(scene, parameters_[i].value(coordinates[i]));
  if (hasMouth()) scene.holding_pipette.contact_radius = scene.holding_pipette.mouth->inner_radius;
  return scene;
}

std::optional<Eigen::VectorXd> SectionFamily::coordinatesOf(const Scene& scene, std::string* misfit) const {
  Eigen::VectorXd coordinates(dimension());
  const std::string text = misfitOf(scene, coordinates);
  if (misfit) *misfit = text;
  return text.empty() ? std::optional(coordinates) : std::nullopt;
}

/// What keeps a scene from having the family's ratios; empty: nothing.
std::string SectionFamily::formMisfit(const Scene& scene) const {
  if (scene.cell.tensegrity) return "the cell is a tensegrity";
  if (hasMouth() && !scene.holding_pipette.mouth) return "holding_pipette has no mouth";
  const Scene::Contact& contact = scene.needle.contact;
  if (kind_ == Kind::kFrictionForce && !(contact.friction > 0)) return "needle/contact/friction is 0";
  if (kind_ == Kind::kWithdrawal && contact.mode == "sliding" && !(contact.friction > 0))
    return "needle/contact slides without friction";
  if (kind_ == Kind::kPierced &&
      (scene.cell.puncture.layers.empty() || !std::isfinite(scene.cell.puncture.layers.front().toughness)))
    return "cell/puncture has no toughness";
  if (kind_ == Kind::kPierced && scene.cell.puncture.opening() > 0) return "cell/puncture has a strength";
  return "";
}

/// Of a scene without dimension; as the border where no other makes a difference.
double SectionFamily::valueOf(const Family::Parameter& parameter, const Scene& scene) const {
  const Scene::Contact& contact = scene.needle.contact;
  const std::string name = parameter.ratio->name;
  if (name == "friction" && contact.mode == "sticking") return parameter.high;
  if (name == "adhesion_range" && contact.adhesion_energy == 0) return parameter.low;
  const double value = parameter.ratio->get(scene);
  return saturates(parameter) ? std::min(value, parameter.high) : value;
}

std::string SectionFamily::misfitOf(const Scene& scene, Eigen::VectorXd& coordinates) const {
  if (const std::string misfit = formMisfit(scene); !misfit.empty()) return misfit;
  if (scene.cell.layers.size() != scene_.cell.layers.size())
    return "layers: " + std::to_string(scene.cell.layers.size()) + ", not " + std::to_string(scene_.cell.layers.size());
  if (!hasOnePoissonRatio(scene)) return "poisson_ratio is not the same in all layers";
  Scene other = withoutDimension(SurrogatePlan::elastic(scene)), own = scene_;
  for (int i = 0; i < dimension(); ++i) {
    const Family::Parameter& each = parameters_[i];
    coordinates[i] = each.coordinate(valueOf(each, other));
  }
  for (const Family::Parameter& constant : constants_) {
    const double value = constant.ratio->get(other);
    if (value < constant.low || (value > constant.high && !saturates(constant))) return constant.text(value);
  }
  // What is left has to be the same.
  if (kind_ == Kind::kWithdrawal) other.needle.contact.mode = own.needle.contact.mode;
  if (hasMouth()) other.holding_pipette.contact_radius = own.holding_pipette.contact_radius;
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

std::string SectionFamily::refusal(const Eigen::VectorXd& coordinates) const {
  std::ostringstream out;
  for (int i = 0; i < dimension(); ++i) {
    if (std::abs(coordinates[i]) <= 1 + kRoundingOfRatio) continue;
    const Family::Parameter& each = parameters_[i];
    out << (out.str().empty() ? "" : "; ") << each.ratio->name << " = " << each.value(coordinates[i])
        << ": must be from " << each.low << " to " << each.high;
  }
  return out.str();
}

std::string SectionFamily::description() const {
  std::ostringstream out;
  out << std::hexfloat << factsOf(kind_).text << name_ << " of ";
  for (const Family::Parameter& parameter : parameters_)
    out << parameter.ratio->name << ' ' << parameter.low << ' ' << parameter.high << ' ';
  out << describeCellAndTip(member(Eigen::VectorXd::Zero(dimension())));
  return out.str();
}

}  // namespace microinjection
