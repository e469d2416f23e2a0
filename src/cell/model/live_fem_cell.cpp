#include "cell/model/live_fem_cell.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "base/errors.h"
#include "cell/mechanics/symmetric_solver.h"
#include "cell/mesh/outer_surface.h"
#include "cell/model/cell_problem.h"
#include "cell/model/contact_frame.h"
#include "cell/model/contact_time.h"
#include "cell/model/scene_mesh.h"

namespace microinjection {
namespace {

/// Largest tip displacement for one solution, over the tip's radius. Shorter ones need as many
/// iterations.
constexpr double kPiece = 0.25;
/// Displacement, over a rounded tip's radius, for which a contact is prepared: at first contact the
/// cell has no stiffness yet.
constexpr double kPrepared = 0.1;
constexpr double kUpright = 0.999;  ///< cosine: within 2.5 degrees
constexpr double kSamePoint = 0.1;  ///< over the tip's radius: the same contact point
constexpr double kHeldRim = 1.001;  ///< over the holding circle's radius

bool isViscoelastic(const Scene& scene) {
  const auto& layers = scene.cell.layers;
  return std::any_of(layers.begin(), layers.end(),
                     [](const Scene::Layer& layer) { return !layer.material.viscoelasticity.empty(); });
}

class SweptPath : public TipPath {
 public:
  SweptPath(const Scene& scene, const QuadraticMesh<2>& section)
      : piece_(kPiece * scene.needle.tip.radius),
        clock_(isViscoelastic(scene)),
        problem_(scene, sweepScene(scene, section, LiveFemCell::kLevel), ElementKind::kP2P0),
        nodes_(outerNodes(problem_.body().mesh())) {
    auto rest = std::make_shared<std::vector<Eigen::Vector3d>>();
    for (int node : nodes_) rest->push_back(problem_.body().mesh().nodes[node]);
    rest_ = std::move(rest);
    for (int layer = 1; layer < static_cast<int>(scene.cell.layers.size()); ++layer) {
      const LayerSurface border = layerSurface(problem_.body().mesh(), layer);
      const int first = static_cast<int>(border_nodes_.size());
      border_nodes_.insert(border_nodes_.end(), border.nodes.begin(), border.nodes.end());
      for (const Eigen::Vector3i& t : border.triangles)
        borders_.push_back({{first + t[0], first + t[1], first + t[2]}, layer});
    }
  }

  IndentationSolution follow(const TipMotion& move) override {
    if (clock_.mustRestart(move)) problem_.reset();
    const Eigen::Vector3d remaining = move.displacement - problem_.tipDisplacement();
    const double share = std::min(1.0, piece_ / std::max(remaining.norm(), 1e-3 * piece_));
    const Eigen::Vector3d target =
        share < 1 ? Eigen::Vector3d(problem_.tipDisplacement() + share * remaining) : move.displacement;
    return problem_.solve(target, clock_.advance(move, share));
  }

  std::shared_ptr<const std::vector<Eigen::Vector3d>> rest() const override { return rest_; }

  Eigen::VectorXd surfaceDisplacement() const override {
    Eigen::VectorXd result(3 * nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      result.segment<3>(3 * i) = problem_.state().segment<3>(3 * nodes_[i]);
    }
    return result;
  }

  std::vector<Eigen::Vector3d> borderVertices() const override {
    std::vector<Eigen::Vector3d> result;
    for (int node : border_nodes_) {
      result.emplace_back(problem_.body().mesh().nodes[node] + problem_.state().segment<3>(3 * node));
    }
    return result;
  }

  const CellProblem<3>& problem() const { return problem_; }
  const std::vector<CellModel::BorderTriangle>& borders() const { return borders_; }

 private:
  double piece_;  ///< m
  ContactTime clock_;
  CellProblem<3> problem_;
  std::vector<int> nodes_;  ///< of the outer surface
  std::vector<int> border_nodes_;
  std::vector<CellModel::BorderTriangle> borders_;
  std::shared_ptr<const std::vector<Eigen::Vector3d>> rest_;
};

}  // namespace

LiveFemCell::LiveFemCell(const Scene& scene) : scene_(scene) {
  scene.validate();
  scene.requireContinuum("elements of the cell's inside");
  scene.requireGlued("a live cell");
  if (scene.needle.contact.adhesion_energy > 0) {  // the extrapolation would be mistaken for adhesion
    throw ConfigError(
        "needle/contact/adhesion: must be left out: a live cell has no adhesion (indent has, and a surrogate cell of a "
        "family)");
  }
  SymmetricSolver::useOneThread();
  const Scene::Tip& tip = scene.needle.tip;
  if (tip.rounded()) tip_ = RoundedTip::make(tip.shape, tip.radius, tip.edge_radius);
  section_ = makeSceneMesh<2>(scene, kLevel);
  try {
    const SweptPath path(scene, section_);
    surface_.vertices = *path.rest();
    const QuadraticMesh<3>& mesh = path.problem().body().mesh();
    for (const Eigen::Vector3i& t : outerTriangles(mesh)) surface_.triangles.push_back({t[0], t[1], t[2]});
    surface_.border_vertices = path.borderVertices();
    surface_.borders = path.borders();
    elements_ = static_cast<int>(mesh.elements.size());
    unknowns_ = path.problem().unknowns();
  } catch (const std::invalid_argument& error) {
    throw ConfigError(std::string("the cell cannot be solved live: ") + error.what());
  }
  const double held = kHeldRim * scene.holding_pipette.contact_radius;
  for (std::size_t i = 0; i < surface_.vertices.size(); ++i) {
    const Eigen::Vector3d& x = surface_.vertices[i];
    if (x.z() < 0 && x.head<2>().norm() <= held) surface_.held.push_back(static_cast<std::uint32_t>(i));
  }
}

std::string LiveFemCell::description() const {
  std::ostringstream text;
  text << "P2-P0 elements on a coarse mesh, whose force is some per cent too large and follows a slow tip only; "
       << elements_ << " tetrahedra, " << unknowns_ << " unknowns";
  return text.str();
}

const char* LiveFemCell::refusal(const Eigen::Vector3d& axis) const {
  return axis.z() < kUpright ? "the needle is not upright, and the live cell under this tip needs it so" : nullptr;
}

std::optional<Eigen::Vector3d> LiveFemCell::touch(const Eigen::Vector3d& tip, const Eigen::Vector3d& /*upright*/,
                                                  int& /*hint*/) const {
  const auto frame = ContactFrame::at(scene_.radius(), tip_, tip.head<2>());
  if (!frame) return std::nullopt;
  return frame->origin;
}

bool LiveFemCell::isClear(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                          const Eigen::Vector3d& contact_point) const {
  if (tip_) return tip_->distance(-tip) > scene_.radius();
  if ((tip - contact_point).dot(axis) > 0) return true;
  const auto now = ContactFrame::at(scene_.radius(), tip_, tip.head<2>());  // it may have moved sideways
  return !now || tip.z() > now->origin.z();
}

ContactPoint LiveFemCell::contactAt(const Eigen::Vector3d& contact_point, const Eigen::Vector3d& /*upright*/) const {
  Eigen::Vector2d line = contact_point.head<2>();
  if (line.norm() < kSamePoint * scene_.needle.tip.radius) line.setZero();
  return {ContactFrame::at(scene_.radius(), tip_, line)->origin, {}};
}

Eigen::Vector3d LiveFemCell::preparedDisplacement() const {
  return tip_ ? Eigen::Vector3d(0, 0, -kPrepared * tip_->radius()) : Eigen::Vector3d::Zero();
}

std::unique_ptr<TipPath> LiveFemCell::path(const ContactPoint& contact_point) const {
  Scene local = scene_;
  local.needle.offset = contact_point.point.head<2>();
  try {
    return std::make_unique<SweptPath>(local, section_);
  } catch (const InvertedElement&) {
    throw std::runtime_error("the live cell's mesh cannot be ordered around a needle so far out");
  }
}

}  // namespace microinjection
