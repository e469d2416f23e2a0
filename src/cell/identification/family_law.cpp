#include "cell/identification/family_law.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/errors.h"
#include "cell/family/family_cell.h"

namespace microinjection {
namespace {

constexpr double kStep = 0.01;  ///< of a ratio's logarithm, for derivatives

}  // namespace

FamilyLaw::FamilyLaw(std::shared_ptr<const FamilyData> family, const Scene& scene,
                     const std::vector<std::string>& free_ratios)
    : family_(std::move(family)), radius_(scene.radius()) {
  const auto coordinates = family_->family().coordinatesOf(scene);
  if (!coordinates || !Family::contains(*coordinates)) {
    throw ConfigError("the scene is not in family " + family_->family().name());
  }
  coordinates_ = *coordinates;
  const auto& known = family_->family().parameters();
  for (const std::string& name : free_ratios) {
    const auto found = std::find_if(known.begin(), known.end(), [&](const auto& p) { return p.ratio->name == name; });
    if (found != known.end()) {
      free_.push_back(static_cast<int>(found - known.begin()));
      continue;
    }
    std::string names;
    for (const auto& parameter : known) names += (names.empty() ? "" : ", ") + std::string(parameter.ratio->name);
    throw ConfigError("--free " + name + ": family " + family_->family().name() + " has " + names);
  }
  Eigen::VectorXd values(free_.size());
  for (std::size_t i = 0; i < free_.size(); ++i) {
    values[static_cast<Eigen::Index>(i)] = known[free_[i]].value(coordinates_[free_[i]]);
  }
  set(values);
}

std::string FamilyLaw::description() const {
  std::ostringstream out;
  out.precision(3);
  out << "family " << family_->family().name() << ", expected force error " << 100 * member_.median_error << " %";
  return out.str();
}

std::vector<ElasticLaw::Parameter> FamilyLaw::parameters() const {
  std::vector<Parameter> result;
  for (const int index : free_) {
    const Family::Parameter& known = family_->family().parameters()[index];
    result.push_back({known.ratio->name, known.value(coordinates_[index]), known.low, known.high});
  }
  return result;
}

SurrogateData FamilyLaw::cellAt(const Eigen::VectorXd& coordinates) const {
  SurrogateData cell = family_->cell(coordinates);
  cell.changeUnits(radius_, radius_ * radius_ * radius_);  // for a modulus of 1 Pa
  return cell;
}

ForceField::Local FamilyLaw::localOf(const SurrogateData& cell) const {
  ForceField::Local local;
  cell.field.makeLocal(0, local);
  return local;
}

void FamilyLaw::set(const Eigen::VectorXd& values) {
  const auto& known = family_->family().parameters();
  above_.clear();
  below_.clear();
  for (std::size_t i = 0; i < free_.size(); ++i) {
    coordinates_[free_[i]] = known[free_[i]].coordinate(values[static_cast<Eigen::Index>(i)]);
  }
  member_ = cellAt(coordinates_);
  local_ = localOf(member_);
  deepest_ = member_.range.axis_depth;
  for (std::size_t i = 0; i < free_.size(); ++i) {
    for (const double sign : {1.0, -1.0}) {
      Eigen::VectorXd moved = coordinates_;
      moved[free_[i]] = known[free_[i]].coordinate(values[static_cast<Eigen::Index>(i)] * std::exp(sign * kStep));
      (sign > 0 ? above_ : below_).push_back(localOf(cellAt(moved)));
    }
  }
}

ElasticLaw::Value FamilyLaw::axisForce(const ForceField::Local& local, double depth) const {
  Eigen::Matrix3d jacobian;
  const double inside = std::min(depth, deepest_);
  const Eigen::Vector3d force = local.evaluate(-inside * Eigen::Vector3d::UnitZ(), jacobian);
  // Beyond its range the force goes on straight.
  return {force.z() - jacobian(2, 2) * (depth - inside), -jacobian(2, 2)};
}

ElasticLaw::Value FamilyLaw::force(double depth, Eigen::VectorXd& by_logarithms) const {
  by_logarithms.resize(static_cast<Eigen::Index>(free_.size()));
  for (std::size_t i = 0; i < free_.size(); ++i) {
    by_logarithms[static_cast<Eigen::Index>(i)] =
        (axisForce(above_[i], depth).force - axisForce(below_[i], depth).force) / (2 * kStep);
  }
  return axisForce(local_, depth);
}

std::shared_ptr<const FamilyData> findFamily(const std::string& folder, const Scene& scene) {
  std::string reason;
  const auto cell = findFamilyCell(folder, scene, reason);
  if (!cell) throw ConfigError("--model family: " + reason);
  return cell->family;
}

}  // namespace microinjection
