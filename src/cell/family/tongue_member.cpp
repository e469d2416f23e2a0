#include "cell/family/tongue_member.h"

#include <algorithm>
#include <boost/math/interpolators/barycentric_rational.hpp>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "cell/model/cell_problem.h"
#include "cell/model/scene_mesh.h"
#include "cell/surrogate/axis_ray.h"

namespace microinjection {
namespace {

constexpr double kFineEdge = 0.2;  ///< of a lip over the bore: sharper ones have finer meshes
constexpr double kFirstRoot = 0.02, kRootStep = 0.0125, kStepGrowth = 1.06;  ///< of the suctions that are solved
constexpr int kMeshes = 3;
constexpr double kNextMesh = 0.3;  ///< level
constexpr int kEvenSteps = 16, kMostSteps = 60, kFewestEquilibria = 12;
constexpr double kSameSuction = 1e-3;  ///< relative: an end so near to the last equilibrium is that

/// Level of scene_mesh.h at which the elements at the lip are a twentieth of the bore's radius or less: a
/// sharp lip ends the path of a coarser mesh early.
double meshLevel(const Scene& scene) {
  const Scene::Mouth& mouth = *scene.holding_pipette.mouth;
  return std::max(0.0, std::log2(kFineEdge * mouth.inner_radius / mouth.edge_radius));
}

/// Roots of the suctions, and what belongs to them: a column each.
struct SolvedTongues {
  std::vector<double> roots;
  std::vector<Eigen::VectorXd> columns;
};

class TonguePath {
 public:
  TonguePath(const Scene& scene, double level)
      : touch_(touchOf(scene)),
        growth_(tongueGrowth(scene)),
        places_(M_PI - tonguePlaces(std::asin(touch_.radius)).array()),
        problem_(scene, makeSceneMesh<2>(scene, level), ElementKind::kP2P1) {}

  /// Until there is no equilibrium any more; `reason` says why.
  SolvedTongues follow(std::string& reason) {
    SolvedTongues solved;
    if (const LoadPath::Result result = problem_.hold(0); !result.converged) return reason = result.reason, solved;
    rest_ = problem_.held();
    double root = kFirstRoot, step = kRootStep;
    for (int i = 0; i < kMostSteps; ++i, root += step) {
      const LoadPath::Result result = problem_.hold(-root * root);
      if (!result.converged) reason = result.reason;
      const double reached = std::sqrt(-problem_.held().pressure);
      const bool new_one = solved.roots.empty() || reached > (1 + kSameSuction) * solved.roots.back();
      if (new_one) add(reached, solved);
      if (!result.converged) return solved;
      if (i >= kEvenSteps) step *= kStepGrowth;
    }
    return solved;
  }

 private:
  void add(double root, SolvedTongues& solved) const {
    const HeldCell held = problem_.held();
    const double a = touch_.bore_radius, s = root * root, length = held.tongue_length - rest_.tongue_length,
                 volume = held.tongue_volume - rest_.tongue_volume;
    if (!(length > 0 && volume > 0)) return;  // where the seal steps it may take more than little suction adds
    const SectionOutline outline = sectionOutline(problem_);
    Eigen::VectorXd column = Eigen::VectorXd::Zero(TongueCurves::kColumns);
    column[TongueCurves::kLogLength] = std::log(length / (a * s)) - growth_;
    column[TongueCurves::kLogVolume] = std::log(volume / (a * a * a * s)) - growth_;
    column[TongueCurves::kSeal] = held.seal_radius / touch_.radius;
    for (Eigen::Index i = 0; i < places_.size(); ++i)
      column.segment<2>(TongueCurves::kSurface + 2 * i) = displacementAt(outline, places_[i]) / a;
    solved.roots.push_back(root);
    solved.columns.push_back(column);
  }

  TongueTouch touch_;
  double growth_;
  Eigen::VectorXd places_;  ///< rad, from the upper pole
  CellProblem<2> problem_;
  HeldCell rest_;
};

}  // namespace

TongueTouch touchOf(const Scene& scene) {
  const Scene::Mouth& mouth = *scene.holding_pipette.mouth;
  return {mouth.inner_radius / scene.radius(), mouth.edge_radius / scene.radius()};
}

double tongueGrowth(const Scene& member) {
  const double bore = member.holding_pipette.mouth->inner_radius / member.radius();
  const double growth = 1.4 * bore * bore;
  if (member.cell.layers.size() < 2) return growth;
  const Scene::Layer& inside = member.cell.layers[1];
  const double thickness = (1 - inside.outer_radius / member.radius()) / bore, squared = thickness * thickness,
               modulus = inside.material.young_modulus / member.cell.material().young_modulus;
  return growth - std::log(modulus + (1 - modulus) * squared / (squared + 0.4));
}

SectionMember solveTongue(const SectionFamily& family, const Eigen::VectorXd& coordinates) {
  const Scene scene = family.member(coordinates);
  std::string reason;
  SolvedTongues solved;
  // On some meshes the contact at a wide mouth does not settle. Then the next finer one is tried.
  for (int i = 0; i < kMeshes && solved.roots.size() < kFewestEquilibria; ++i)
    solved = TonguePath(scene, meshLevel(scene) + kNextMesh * i).follow(reason);
  const std::size_t count = solved.roots.size();
  if (count < kFewestEquilibria) throw std::runtime_error("the tongue's equilibria end early: " + reason);
  const double end = solved.roots.back();
  const Eigen::VectorXd roots = std::sqrt(kServedSuction) * end * tongueFractions().cwiseSqrt();
  SectionMember member{coordinates, Eigen::MatrixXd(roots.size(), TongueCurves::kColumns)};
  std::vector<double> row(count);
  for (Eigen::Index k = 0; k < TongueCurves::kColumns; ++k) {
    for (std::size_t i = 0; i < count; ++i) row[i] = solved.columns[i][k];
    const boost::math::barycentric_rational<double> curve(solved.roots.data(), row.data(), count);
    for (Eigen::Index i = 0; i < roots.size(); ++i) member.curves(i, k) = curve(roots[i]);
  }
  member.curves.col(TongueCurves::kLogEnd).setConstant(2 * std::log(end));
  // Of the path's reasons, those of a solution that gives up have no such word.
  member.curves.col(TongueCurves::kEnds).setConstant(reason.find("stable") != std::string::npos ? 1 : 0);
  return member;
}

}  // namespace microinjection
