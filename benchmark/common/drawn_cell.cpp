#include "benchmark/common/drawn_cell.h"

#include <cmath>
#include <stdexcept>

#include "base/errors.h"
#include "cell/family/family_file.h"
#include "cell/family/family_member.h"

namespace microinjection {
namespace {

constexpr char kFamilies[] = MICROINJECTION_SOURCE_DIR "/config/families/";
constexpr double kSoftest = 5e3, kStiffest = 25e3;  // Pa

Scene scaled(Scene scene, double radius, double modulus) {
  for (Scene::Layer& layer : scene.cell.layers) {
    layer.outer_radius *= radius;
    layer.material.young_modulus *= modulus;
  }
  scene.needle.tip.radius *= radius;
  scene.needle.tip.edge_radius *= radius;
  scene.holding_pipette.contact_radius *= radius;
  return scene;
}

}  // namespace

std::shared_ptr<const FamilyData> loadFamilyData(const std::string& name) {
  const std::string file = kFamilies + name + ".yaml";
  auto read = FamilyData::load(Family::load(file), familyDataFile(file));
  if (!read) throw ConfigError(read.reason);
  return std::make_shared<const FamilyData>(std::move(*read.content));
}

double uniform(double low, double high, std::mt19937& random) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

double DrawnCell::force(double depth) const { return depth > 0 ? unit * curve(std::sqrt(depth / length)) : 0; }

Scene DrawnCell::withModulus(double other) const {
  Scene result = scene;
  for (Scene::Layer& layer : result.cell.layers) layer.material.young_modulus *= other / modulus;
  return result;
}

DrawnCell drawCell(const FamilyData& data, double radius, double deep, std::mt19937& random) {
  const Family& family = data.family();
  for (;;) {
    Eigen::VectorXd coordinates(family.dimension());
    for (double& x : coordinates) x = uniform(-1, 1, random);
    const Scene member = family.member(coordinates);
    const SurrogatePlan plan = planMember(family, member);
    DrawnCell cell;
    cell.length = plan.range.axis_depth * radius;
    if (cell.length < deep) continue;
    try {
      cell.curve = axisCurve(solveAxisForces(family, coordinates).array().log().matrix());
    } catch (const std::runtime_error&) {  // it does not converge that deep
      continue;
    }
    cell.modulus = std::exp(uniform(std::log(kSoftest), std::log(kStiffest), random));
    cell.unit = cell.modulus * plan.scales.energy / plan.scales.length * radius * radius;
    cell.scene = scaled(member, radius, cell.modulus);
    return cell;
  }
}

}  // namespace microinjection
