#include "python/bindings/served_forces.h"

#include <cmath>
#include <limits>

#include "base/errors.h"
#include "cell/choice/make_cell_model.h"
#include "cell/surrogate/surface_grid.h"

namespace microinjection {
namespace {

constexpr double kUpright = 0.999;  ///< cosine of the needle's tilt that surrogate data bear, 2.5 degrees
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

void put(double* to, Eigen::Index tip, const Eigen::Vector3d& force) {
  if (to) Eigen::Map<Eigen::Vector3d>(to + 3 * tip) = force;
}

void put(double* to, Eigen::Index tip, const Eigen::Matrix3d& stiffness) {
  if (to) Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(to + 9 * tip) = stiffness;
}

/// The contact of one needle with a live cell.
struct LiveContact {
  Eigen::Vector3d point;
  std::unique_ptr<TipPath> path;
};

}  // namespace

ServedForces::ServedForces(std::shared_ptr<const Scene> scene, const std::string& model, const std::string& families)
    : scene_(std::move(scene)) {
  if (model != "auto" && model != "surrogate" && model != "live")
    throw ConfigError("model = " + model + ": must be one of: auto, surrogate, live");
  const ServingPlan plan = planServing(*scene_, model, families, "prepare --scene with the scene's file");
  const std::shared_ptr<const Scene> planned = scene_;
  scene_ = plan.scene;
  glued_error_ = plan.glued_error;
  if (planned->needle.contact.adhesion_energy > 0 && plan.loss)
    throw ConfigError("needle/contact/adhesion: must be left out: these forces are those of the way in");
  description_ = plan.reason + (plan.loss ? "; these forces are those of the way in" : "");
  family_ = plan.source.family;
  if (plan.served == Served::kSurrogate) {
    data_ = plan.source.data;
    contact_ = std::make_unique<SurrogateContact>(*scene_, data_);
  } else {
    live_ = makeLiveCell(*scene_);
    description_ += ": " + live_->description();
  }
}

std::string ServedForces::refusal(const Eigen::Vector3d& axis) const {
  return axis.z() < kUpright ? "must be within 2.5 degrees of (0, 0, 1): a force is that on an upright needle" : "";
}

std::optional<std::pair<double, double>> ServedForces::expectedError() const {
  if (!data_) return std::nullopt;
  return std::pair(data_->median_error + glued_error_, data_->common_error + glued_error_);
}

void ServedForces::evaluate(const Eigen::Ref<const Eigen::Matrix3Xd>& tips, bool along, const Wanted& wanted,
                            void (*progress)()) const {
  if (live_) return evaluateLive(tips, along, wanted, progress);
  const std::unique_lock<std::mutex> lock(contact_mutex_, std::try_to_lock);
  if (lock) return evaluateSurrogate(*contact_, tips, along, wanted);
  SurrogateContact own(*scene_, data_);
  evaluateSurrogate(own, tips, along, wanted);
}

void ServedForces::evaluateSurrogate(SurrogateContact& contact, const Eigen::Ref<const Eigen::Matrix3Xd>& tips,
                                     bool along, const Wanted& wanted) const {
  contact.reset();
  for (Eigen::Index i = 0; i < tips.cols(); ++i) {
    if (!along) contact.reset();
    const SurrogateContact::Result at = contact.step(tips.col(i));
    const bool valid = at.prepared && !at.too_deep;
    put(wanted.forces, i, valid ? at.force : Eigen::Vector3d::Constant(kNone));
    put(wanted.stiffnesses, i, valid ? at.stiffness : Eigen::Matrix3d::Constant(kNone));
  }
}

void ServedForces::evaluateLive(const Eigen::Ref<const Eigen::Matrix3Xd>& tips, bool along, const Wanted& wanted,
                                void (*progress)()) const {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  std::optional<LiveContact> contact;
  int hint = 0;
  for (Eigen::Index i = 0; i < tips.cols(); ++i) {
    progress();
    const Eigen::Vector3d tip = tips.col(i);
    if (!along) contact.reset();
    if (contact && live_->isClear(tip, up, contact->point)) contact.reset();
    if (!contact) {
      const auto touch = live_->touch(tip, up, hint);
      if (touch && !live_->isClear(tip, up, *touch)) {
        const Eigen::Vector3d point = snapToNeedleLine(scene_->needle, *touch);
        contact = LiveContact{point, live_->path(live_->contactAt(point, up))};
      }
    }
    IndentationSolution solution;
    solution.converged = true;
    solution.force.setZero();
    if (contact) {
      const Eigen::Vector3d goal = tip - contact->point;
      do {
        progress();
        solution = contact->path->follow({goal, 0, std::nullopt, 0});
      } while (solution.converged && solution.tip_displacement != goal);
    }
    put(wanted.forces, i, solution.converged ? solution.force : Eigen::Vector3d::Constant(kNone));
    const Eigen::Matrix3d stiffness = contact ? solution.stiffness : Eigen::Matrix3d::Zero();
    put(wanted.stiffnesses, i, solution.converged ? stiffness : Eigen::Matrix3d::Constant(kNone));
  }
}

ServedForces::Surface ServedForces::surface(const Eigen::Vector3d& tip) const {
  Surface surface;
  if (live_) {
    const LiveCell::Surface rest = live_->undeformedSurface();
    surface.triangles = rest.triangles;
    surface.at_rest.resize(3, static_cast<Eigen::Index>(rest.vertices.size()));
    for (std::size_t i = 0; i < rest.vertices.size(); ++i)
      surface.at_rest.col(static_cast<Eigen::Index>(i)) = rest.vertices[i];
    surface.vertices = surface.at_rest;
    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    int hint = 0;
    const auto touch = live_->touch(tip, up, hint);
    if (!touch || live_->isClear(tip, up, *touch)) return surface;
    const Eigen::Vector3d point = snapToNeedleLine(scene_->needle, *touch);
    const auto path = live_->path(live_->contactAt(point, up));
    IndentationSolution solution;
    do {
      solution = path->follow({tip - point, 0, std::nullopt, 0});
    } while (solution.converged && solution.tip_displacement != tip - point);
    if (!solution.converged) throw ConfigError("tip: " + solution.reason);
    if (const auto own = path->rest()) {
      for (std::size_t i = 0; i < own->size(); ++i) surface.at_rest.col(static_cast<Eigen::Index>(i)) = (*own)[i];
    }
    const Eigen::VectorXd moved = path->surfaceDisplacement();
    surface.vertices = surface.at_rest + Eigen::Map<const Eigen::Matrix3Xd>(moved.data(), 3, surface.at_rest.cols());
    return surface;
  }
  SurrogateContact contact(*scene_, data_);
  const SurrogateContact::Result at = contact.step(tip);
  if (!at.prepared || at.too_deep) throw ConfigError("tip: the cell has no valid force there, and so no surface");
  Eigen::Matrix3Xd displaced;
  SurrogateContact::surface(*data_, contact.shape(), surface.at_rest, displaced);
  surface.vertices = surface.at_rest + displaced;
  for (const Eigen::Vector3i& triangle : SurfaceGrid::standard().triangles())
    surface.triangles.push_back({triangle[0], triangle[1], triangle[2]});
  return surface;
}

}  // namespace microinjection
