#include "cell/identification/rival_cells.h"

#include <cmath>
#include <sstream>

#include "cell/family/family_file.h"
#include "cell/model/similarity.h"

namespace microinjection {
namespace {

constexpr int kModuli = 9, kThicknesses = 6;  ///< of the layers' ratios, from border to border

/// Coordinates of the family's members on the grid; none when the family has no such tip.
std::vector<Eigen::VectorXd> gridOf(const Family& family, const Scene& scene) {
  std::vector<Eigen::VectorXd> points{Eigen::VectorXd::Zero(family.dimension())};
  for (int i = 0; i < family.dimension(); ++i) {
    const Family::Parameter& parameter = family.parameters()[static_cast<std::size_t>(i)];
    const bool of_layers = parameter.ratio->layers > 1;
    if (!of_layers) {
      const double at = parameter.coordinate(parameter.ratio->get(scene));
      if (!(std::abs(at) <= 1 + 1e-9)) return {};
      for (Eigen::VectorXd& point : points) point[i] = at;
      continue;
    }
    const int steps = std::string(parameter.ratio->name) == "core_modulus" ? kModuli : kThicknesses;
    std::vector<Eigen::VectorXd> next;
    for (const Eigen::VectorXd& point : points) {
      for (int k = 0; k < steps; ++k) {
        next.push_back(point);
        next.back()[i] = -1 + 2.0 * k / (steps - 1);
      }
    }
    points = std::move(next);
  }
  return points;
}

std::string describe(const Family& family, const Eigen::VectorXd& point) {
  std::ostringstream out;
  out.precision(2);
  out << family.name();
  for (int i = 0; i < family.dimension(); ++i) {
    const Family::Parameter& parameter = family.parameters()[static_cast<std::size_t>(i)];
    if (parameter.ratio->layers > 1) out << ", " << parameter.ratio->name << ' ' << parameter.value(point[i]);
  }
  return out.str();
}

}  // namespace

std::vector<RivalCell> rivalCells(const std::vector<std::shared_ptr<const FamilyData>>& families, const Scene& scene) {
  const Scene own = withoutDimension(scene);
  const double radius = scene.radius();
  std::vector<RivalCell> cells;
  for (const auto& data : families) {
    if (!data->hasAxisCurves()) continue;
    for (const Eigen::VectorXd& point : gridOf(data->family(), own)) {
      if (!data->serves(point)) continue;
      const AxisForce force = data->axisForce(point);
      const double length = force.length * radius, unit = force.unit * radius * radius;
      cells.push_back({describe(data->family(), point),
                       AxisShape([&](double depth) { return unit * force.curve(std::sqrt(depth / length)); }, length)});
    }
  }
  return cells;
}

std::vector<std::shared_ptr<const FamilyData>> loadFamilies(const std::string& folder) {
  std::vector<std::shared_ptr<const FamilyData>> families;
  for (const std::string& file : familyFiles(folder)) {
    auto read = FamilyData::load(Family::load(file), familyDataFile(file));
    if (read) families.push_back(std::make_shared<const FamilyData>(std::move(*read.content)));
  }
  return families;
}

}  // namespace microinjection
