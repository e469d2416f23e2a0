#include "cell/family/held_force_family.h"

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

constexpr double kDeepestHeld = 0.6;  ///< over the cell's radius
constexpr int kHeldDepths = 12, kFewestHeldDepths = 6;
constexpr double kHeldMesh = 0;            ///< level of scene_mesh.h
constexpr double kMeshOfHeldRatio = 2e-3;  ///< what a finer mesh changes of a ratio

std::vector<double> rootsOfDepths() {
  std::vector<double> roots;
  for (const double depth : heldForceDepths()) roots.push_back(std::sqrt(depth));
  return roots;
}

}  // namespace

Eigen::VectorXd heldForceDepths() {
  Eigen::VectorXd depths(kHeldDepths);
  for (int i = 0; i < kHeldDepths; ++i) depths[i] = kDeepestHeld * std::pow((i + 1.0) / kHeldDepths, 2);
  return depths;
}

HeldForce::HeldForce(const Eigen::VectorXd& log_ratios, double error)
    : largest_(std::max(std::expm1(log_ratios.maxCoeff()), -std::expm1(log_ratios.minCoeff()))),
      error_(std::hypot(error, kMeshOfHeldRatio)),
      curve_(rootsOfDepths().data(), log_ratios.data(), static_cast<std::size_t>(log_ratios.size())) {}

double HeldForce::ratio(double depth) const {
  static const double kFirst = std::sqrt(heldForceDepths()[0]), kLast = std::sqrt(kDeepestHeld);
  return std::exp(curve_(std::clamp(std::sqrt(std::max(depth, 0.0)), kFirst, kLast)));
}

void HeldForce::applyTo(SurrogateData& data, double radius) const {
  const EnergyScales scales = data.energy.scales();
  const auto factor = [&](double s) { return ratio(s * s * scales.length / radius); };
  const AxisCurve size = axisCurve(data.field, scales);
  data.energy.scaleAlongPaths(factor, size);
  data.field.scaleAlongPaths(factor, size);
}

MouthMember solveHeldForce(const MouthFamily& family, const Eigen::VectorXd& coordinates) {
  const Scene held = family.member(coordinates), glued = held.glued();
  CellProblem<2> own(held, makeSceneMesh<2>(held, kHeldMesh), ElementKind::kP2P0);
  CellProblem<2> other(glued, makeSceneMesh<2>(glued, kHeldMesh), ElementKind::kP2P0);
  const Eigen::VectorXd depths = heldForceDepths();
  MouthMember member{coordinates, Eigen::MatrixXd(kHeldDepths, 1)};
  std::string reason;
  int known = 0;
  for (; known < kHeldDepths; ++known) {
    const Eigen::Vector3d tip = -depths[known] * Eigen::Vector3d::UnitZ();
    const IndentationSolution one = own.solve(tip), two = other.solve(tip);
    reason = one.reason + two.reason;
    if (!one.converged || !two.converged) break;
    member.curves(known, 0) = std::log(one.force.z() / two.force.z());
  }
  if (known < kFewestHeldDepths) throw std::runtime_error("the held cell's equilibria end early: " + reason);
  for (; known < kHeldDepths; ++known) member.curves(known, 0) = member.curves(known - 1, 0);
  if (!member.curves.allFinite()) throw std::runtime_error("a force on the held cell is not positive");
  return member;
}

HeldForceFamily::HeldForceFamily(MouthFamilyData data) : data_(std::move(data)) {
  if (data_.family().kind() != MouthFamily::Kind::kHeldForce)
    throw std::invalid_argument("family " + data_.family().name() + " has no held forces");
  for (const MouthMember& member : data_.members()) {
    if (member.curves.rows() != kHeldDepths || member.curves.cols() != 1)
      throw ConfigError("family " + data_.family().name() + ": its data have other curves than held forces");
  }
}

HeldForce HeldForceFamily::force(const Eigen::VectorXd& coordinates) const {
  const MouthFamilyData::Prediction found = data_.predict(coordinates);
  return {found.curves.col(0), found.error[0]};
}

std::optional<HeldForce> findHeldForce(const std::string& families, const Scene& scene, std::string& reason) {
  reason.clear();
  if (families.empty()) return std::nullopt;
  for (const std::string& file : familyFiles(families + "/held")) {
    try {
      const HeldForceFamily family(MouthFamilyData::loadBoth(file));
      return family.force(family.data().coordinatesOf(scene));
    } catch (const ConfigError& error) {
      reason += (reason.empty() ? "" : "; ") + std::string(error.what());
    }
  }
  if (reason.empty()) reason = families + "/held has no family";
  return std::nullopt;
}

}  // namespace microinjection
