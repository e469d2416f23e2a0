#include "cell/family/axis_force_ratio.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "cell/family/axis_force.h"
#include "cell/family/family_file.h"
#include "cell/model/cell_problem.h"
#include "cell/model/scene_mesh.h"

namespace microinjection {
namespace {

constexpr double kDeepestRatio = 0.6;  ///< over the cell's radius
constexpr int kRatioDepths = 12, kFewestRatioDepths = 6;
constexpr double kRatioMesh = 0;       ///< level of scene_mesh.h
constexpr double kMeshOfRatio = 2e-3;  ///< what a finer mesh changes of a ratio

std::vector<double> rootsOfDepths() {
  std::vector<double> roots;
  for (const double depth : axisRatioDepths()) roots.push_back(std::sqrt(depth));
  return roots;
}

}  // namespace

Eigen::VectorXd axisRatioDepths() {
  Eigen::VectorXd depths(kRatioDepths);
  for (int i = 0; i < kRatioDepths; ++i) depths[i] = kDeepestRatio * std::pow((i + 1.0) / kRatioDepths, 2);
  return depths;
}

AxisForceRatio::AxisForceRatio(const Eigen::VectorXd& log_ratios, double error)
    : largest_(std::max(std::expm1(log_ratios.maxCoeff()), -std::expm1(log_ratios.minCoeff()))),
      error_(std::hypot(error, kMeshOfRatio)),
      curve_(rootsOfDepths().data(), log_ratios.data(), static_cast<std::size_t>(log_ratios.size())) {}

double AxisForceRatio::ratio(double depth) const {
  static const double kFirst = std::sqrt(axisRatioDepths()[0]), kLast = std::sqrt(kDeepestRatio);
  return std::exp(curve_(std::clamp(std::sqrt(std::max(depth, 0.0)), kFirst, kLast)));
}

void AxisForceRatio::applyTo(SurrogateData& data, double radius) const {
  const EnergyScales scales = data.energy.scales();
  const auto factor = [&](double s) { return ratio(s * s * scales.length / radius); };
  const AxisCurve size = axisCurve(data.field, scales);
  data.energy.scaleAlongPaths(factor, size);
  data.field.scaleAlongPaths(factor, size);
}

Scene stuck(Scene scene) {
  scene.needle.contact.mode = "sticking";
  scene.needle.contact.friction = 0;
  return scene;
}

SectionMember solveAxisForceRatio(const SectionFamily& family, const Eigen::VectorXd& coordinates) {
  const Scene scene = family.member(coordinates);
  const Scene simple = family.kind() == SectionFamily::Kind::kHeldForce ? scene.glued() : stuck(scene);
  CellProblem<2> own(scene, makeSceneMesh<2>(scene, kRatioMesh), ElementKind::kP2P0);
  CellProblem<2> other(simple, makeSceneMesh<2>(simple, kRatioMesh), ElementKind::kP2P0);
  const Eigen::VectorXd depths = axisRatioDepths();
  SectionMember member{coordinates, Eigen::MatrixXd(kRatioDepths, 1)};
  std::string reason;
  int known = 0;
  for (; known < kRatioDepths; ++known) {
    const Eigen::Vector3d tip = -depths[known] * Eigen::Vector3d::UnitZ();
    const IndentationSolution one = own.solve(tip), two = other.solve(tip);
    reason = one.reason + two.reason;
    if (!one.converged || !two.converged) break;
    member.curves(known, 0) = std::log(one.force.z() / two.force.z());
  }
  if (known < kFewestRatioDepths) throw std::runtime_error("the cell's equilibria end early: " + reason);
  for (; known < kRatioDepths; ++known) member.curves(known, 0) = member.curves(known - 1, 0);
  if (!member.curves.allFinite()) throw std::runtime_error("a force is not positive");
  return member;
}

AxisForceRatioFamily::AxisForceRatioFamily(SectionFamilyData data) : data_(std::move(data)) {
  const SectionFamily::Kind kind = data_.family().kind();
  if (kind != SectionFamily::Kind::kHeldForce && kind != SectionFamily::Kind::kFrictionForce)
    throw std::invalid_argument("family " + data_.family().name() + " has no forces on the axis");
  for (const SectionMember& member : data_.members()) {
    if (member.curves.rows() != kRatioDepths || member.curves.cols() != 1)
      throw ConfigError("family " + data_.family().name() + ": its data have other curves than forces on the axis");
  }
}

AxisForceRatio AxisForceRatioFamily::force(const Eigen::VectorXd& coordinates) const {
  const SectionFamilyData::Prediction found = data_.predict(coordinates);
  return {found.curves.col(0), found.error[0]};
}

namespace {

std::optional<AxisForceRatio> findIn(const std::string& families, const std::string& folder, const Scene& scene,
                                     std::string& reason) {
  return firstFamilyWith(families, folder, reason, [&](const std::string& file) {
    const AxisForceRatioFamily family(SectionFamilyData::loadBoth(file));
    return family.force(family.data().coordinatesOf(scene));
  });
}

}  // namespace

std::optional<AxisForceRatio> findHeldForce(const std::string& families, const Scene& scene, std::string& reason) {
  return findIn(families, "held", scene, reason);
}

std::optional<AxisForceRatio> findFrictionForce(const std::string& families, const Scene& scene, std::string& reason) {
  return findIn(families, "friction", scene, reason);
}

}  // namespace microinjection
