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
constexpr double kTrembling = 0.1e-6;  ///< m, by which a needle at rest may move deeper
constexpr double kRest = 0.1;          ///< s
constexpr double kUpright = 0.999;     ///< cosine: within 2.5 degrees of the prepared direction

}  // namespace

SurrogateCellModel::SurrogateCellModel(const Scene& scene, std::shared_ptr<const SurrogateData> cell)
    : scene_(scene),
      cell_(std::move(cell)),
      needle_(scene, cell_),
      memory_(scene.cell.material().viscoelasticity.prony) {
  invalid_reason_.reserve(200);
}

TipForce SurrogateCellModel::invalidForce(const char* reason) {
  invalid_reason_ = reason;
  return {false, Eigen::Vector3d::Zero()};
}

void SurrogateCellModel::release() {
  contact_.reset();
  needle_.reset();
  memory_.reset();
  invalid_reason_.clear();
  shape_.write(needle_.shape());
}

TipForce SurrogateCellModel::step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) {
  if (!tip.allFinite() || !axis.allFinite() || !std::isfinite(time)) {
    return invalidForce("the needle's pose is not finite");
  }
  TipForce force = computeForce(tip, axis, std::max(0.0, time - time_));
  time_ = time;
  shape_.write(needle_.shape());
  return force;
}

/// An invalid force holds the needle. After a rest, the hand may withdraw it, but not push it
/// further.
bool SurrogateCellModel::continuesBelow(bool too_deep, double duration) {
  if (!too_deep) {
    deepest_ = rested_ = 0;
  } else if (contact_->indentation > deepest_ + kTrembling) {
    deepest_ = contact_->indentation;
    rested_ = 0;
  } else {
    rested_ += duration;
  }
  return too_deep && rested_ < kRest;
}

TipForce SurrogateCellModel::computeForce(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double duration) {
  invalid_reason_.clear();
  const SurrogateContact::Result prepared = needle_.step(tip);
  stiffness_ = prepared.stiffness;
  if (!needle_.contactFrame()) {
    contact_.reset();
    memory_.reset();
    return {};
  }
  const Eigen::Vector3d viscous = memory_.step(prepared.force, duration);
  Eigen::Vector3d force = prepared.force + viscous;
  if (!viscous.isZero(0)) force -= std::min(0.0, force.dot(axis)) * axis;  // relaxed so far that the cell would pull
  if (!contact_) contact_ = Contact{};
  contact_->contact_point = needle_.contactFrame()->origin;
  contact_->displacement = tip - contact_->contact_point;
  contact_->indentation = -contact_->displacement.dot(axis);
  if (axis.z() < kUpright) return invalidForce("the needle is not upright, and the cell was prepared for that only");
  if (needle_.contactFrame()->angle > 1.001 * cell_->range.angle) return invalidForce(kTooFarOut);
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
  needle_.surface({}, rest, displaced);
  std::vector<std::uint32_t> result;
  for (Eigen::Index i = 0; i < rest.cols(); ++i) {
    const bool inside = rest.col(i).head<2>().norm() <= 1.001 * scene_.holding_pipette.contact_radius;
    if (rest(2, i) < 0 && inside) result.push_back(static_cast<std::uint32_t>(i));
  }
  return result;
}

CellModel::DeformedSurface SurrogateCellModel::deformedSurface() {
  Eigen::Matrix3Xd rest, displaced;
  shape_.update();
  needle_.surface(shape_.value(), rest, displaced);
  DeformedSurface surface;
  for (Eigen::Index i = 0; i < rest.cols(); ++i) {
    surface.vertices.emplace_back(rest.col(i) + displaced.col(i));
    surface.displacement.push_back(displaced.col(i).norm());
  }
  return surface;
}

}  // namespace microinjection
