#include "cell/surrogate/surrogate_cell_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cell/surrogate/surface_grid.h"

namespace microinjection {
namespace {

constexpr char kBeside[] = "the tip is beside the range that the cell was prepared for: the force fades";
constexpr char kTooDeep[] = "the tip is deeper than the cell was prepared for: withdraw it";
constexpr char kTooFarOut[] = "the tip touched the cell further from its pole than what was prepared";
constexpr double kTremor = 0.1e-6;      ///< m, by which a needle at rest may move deeper
constexpr double kRest = 0.1;           ///< s
constexpr std::size_t kKept = 16;       ///< cells, for the thread that draws
constexpr double kOnAxisAngle = 0.035;  ///< rad, of the contact point
constexpr double kOnAxisTips = 0.1;     ///< tip radii, sideways
constexpr double kUpright = 0.999;      ///< cosine: within 2.5 degrees of the prepared direction

}  // namespace

SurrogateCellModel::SurrogateCellModel(const Scene& scene, std::shared_ptr<const SurrogateData> cell)
    : SurrogateCellModel(scene, std::move(cell), MoreError()) {}

SurrogateCellModel::SurrogateCellModel(const Scene& scene, std::shared_ptr<const SurrogateData> cell,
                                       const MoreError& error)
    : needle_(std::make_unique<SurrogateContact>(scene, cell)),
      memory_(scene.cell.material().viscoelasticity.prony),
      served_{{std::make_shared<const Scene>(scene), cell}},
      more_error_(error) {
  invalid_reason_.reserve(200);
}

void SurrogateCellModel::change(const Scene& scene, std::shared_ptr<const SurrogateData> cell) {
  auto next = std::make_unique<SurrogateContact>(scene, cell);
  {
    const std::lock_guard<std::mutex> lock(served_mutex_);
    served_.push_back({std::make_shared<const Scene>(scene), std::move(cell)});
    if (served_.size() > kKept) served_.erase(served_.begin());
  }
  needle_.change(std::move(next));
}

/// The newest for one that is no longer kept, because the drawing thread was too slow for it.
SurrogateCellModel::Served SurrogateCellModel::served(const SurrogateData* cell) {
  const std::lock_guard<std::mutex> lock(served_mutex_);
  for (const Served& one : served_) {
    if (one.cell.get() == cell) return one;
  }
  return served_.back();
}

TipForce SurrogateCellModel::invalidForce(const char* reason) {
  invalid_reason_ = reason;
  force_error_.reset();
  return {false, Eigen::Vector3d::Zero()};
}

void SurrogateCellModel::release() {
  contact_.reset();
  needle_.reset();
  memory_.reset();
  limit_.reset();
  invalid_reason_.clear();
  force_error_.reset();
  shape_.write(needle_.felt().shape());
}

TipForce SurrogateCellModel::step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) {
  if (!tip.allFinite() || !axis.allFinite() || !std::isfinite(time)) {
    return invalidForce("the needle's pose is not finite");
  }
  TipForce force = computeForce(tip, axis, std::max(0.0, time - time_));
  time_ = time;
  force_error_ = errorOf(force, axis);
  shape_.write(needle_.felt().shape());
  return force;
}

std::optional<double> SurrogateCellModel::errorOf(const TipForce& force, const Eigen::Vector3d& axis) const {
  if (!force.valid || !invalid_reason_.empty() || changing_) return std::nullopt;
  if (!contact_) return 0;
  const SurrogateContact& felt = needle_.felt();
  const double beside = (contact_->displacement + contact_->indentation * axis).norm();
  const bool on_axis =
      felt.contactFrame()->angle < kOnAxisAngle && beside < kOnAxisTips * felt.scene().needle.tip.radius;
  if (more_error_.on_axis_only && !on_axis) return std::nullopt;
  return (felt.cell()->common_error + more_error_.more) * force.force.norm();
}

/// An invalid force holds the needle. After a rest, the hand may withdraw it, but not push it
/// further.
bool SurrogateCellModel::continuesBelow(bool too_deep, double duration) {
  if (!too_deep) {
    deepest_ = rested_ = 0;
  } else if (contact_->indentation > deepest_ + kTremor) {
    deepest_ = contact_->indentation;
    rested_ = 0;
  } else {
    rested_ += duration;
  }
  return too_deep && rested_ < kRest;
}

TipForce SurrogateCellModel::computeForce(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double duration) {
  invalid_reason_.clear();
  const ChangingContact::Result prepared = needle_.step(tip, duration);
  const std::optional<ContactFrame>& frame = needle_.felt().contactFrame();
  stiffness_ = prepared.stiffness;
  changing_ = prepared.changing;
  if (!frame) {
    contact_.reset();
    memory_.reset();
    limit_.reset();
    return {};
  }
  if (prepared.changing) limit_.activate();
  const Eigen::Vector3d viscous = memory_.step(prepared.force, duration);
  Eigen::Vector3d force = prepared.force + viscous;
  if (!viscous.isZero(0)) force -= std::min(0.0, force.dot(axis)) * axis;  // relaxed so far that the cell would pull
  force = limit_.step(force, tip, prepared.energy);
  if (!contact_) contact_ = Contact{};
  contact_->contact_point = frame->origin;
  contact_->displacement = tip - contact_->contact_point;
  contact_->indentation = -contact_->displacement.dot(axis);
  if (axis.z() < kUpright) return invalidForce("the needle is not upright, and the cell was prepared for that only");
  if (frame->angle > 1.001 * needle_.felt().cell()->range.angle) return invalidForce(kTooFarOut);
  if (continuesBelow(prepared.too_deep, duration)) return invalidForce(kTooDeep);
  if (prepared.too_deep) invalid_reason_ = kTooDeep;
  if (!prepared.prepared && invalid_reason_.empty()) invalid_reason_ = kBeside;
  return {true, force};
}

std::optional<CellModel::Solution> SurrogateCellModel::solution(double /*time*/) const {
  if (!contact_) return std::nullopt;
  Solution result;
  result.stiffness = stiffness_;
  return result;
}

std::vector<std::array<int, 3>> SurrogateCellModel::triangles() const {
  std::vector<std::array<int, 3>> result;
  for (const Eigen::Vector3i& t : SurfaceGrid::standard().triangles()) result.push_back({t[0], t[1], t[2]});
  return result;
}

std::vector<std::uint32_t> SurrogateCellModel::held() const {
  Eigen::Matrix3Xd rest, displaced;
  const SurrogateContact& felt = needle_.felt();
  SurrogateContact::surface(*felt.cell(), {}, rest, displaced);
  std::vector<std::uint32_t> result;
  for (Eigen::Index i = 0; i < rest.cols(); ++i) {
    const bool inside = rest.col(i).head<2>().norm() <= 1.001 * felt.scene().holding_pipette.contact_radius;
    if (rest(2, i) < 0 && inside) result.push_back(static_cast<std::uint32_t>(i));
  }
  return result;
}

CellModel::DeformedSurface SurrogateCellModel::deformedSurface() {
  Eigen::Matrix3Xd rest, displaced;
  shape_.update();
  const Served drawn = served(shape_.value().cell);
  SurrogateContact::surface(*drawn.cell, shape_.value(), rest, displaced);
  DeformedSurface surface;
  surface.scene = drawn.scene;
  for (Eigen::Index i = 0; i < rest.cols(); ++i) {
    surface.at_rest.emplace_back(rest.col(i));
    surface.vertices.emplace_back(rest.col(i) + displaced.col(i));
    surface.displacement.push_back(displaced.col(i).norm());
  }
  return surface;
}

}  // namespace microinjection
