#include "surrogate/prepared_tracker.h"

#include <utility>

namespace microinjection {
namespace {

constexpr double kUpright = 0.999;  ///< cosine: within 2.5 degrees of the prepared direction

}  // namespace

PreparedTracker::PreparedTracker(const Scene& scene, std::shared_ptr<const PreparedCell> cell)
    : scene_(scene), cell_(std::move(cell)), needle_(scene, cell_) {
  distrust_.reserve(200);
}

TipForce PreparedTracker::distrustBecause(const char* reason) {
  distrust_ = reason;
  return {false, Eigen::Vector3d::Zero()};
}

TipForce PreparedTracker::step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double /*time*/) {
  distrust_.clear();
  if (punctured_) return {};
  const PreparedContact::Answer answer = needle_.step(tip);
  stiffness_ = answer.stiffness;
  if (!needle_.place()) {
    contact_.reset();
    return {};
  }
  if (!contact_) contact_ = Contact{};
  contact_->touched_at = needle_.place()->origin;
  contact_->displacement = tip - contact_->touched_at;
  contact_->indentation = -contact_->displacement.dot(axis);
  if (axis.z() < kUpright) return distrustBecause("the needle is not upright, and the cell was prepared for that only");
  if (!answer.prepared) return distrustBecause("the tip is out of the range that the cell was prepared for");
  if (answer.force.dot(axis) >= scene_.cell.puncture_force) {
    punctured_ = true;
    contact_.reset();
    needle_.reset();
    return {};
  }
  return {true, answer.force};
}

std::optional<CellUnderNeedle::Solution> PreparedTracker::solution(double /*time*/) const {
  if (!contact_) return std::nullopt;
  Solution result;
  result.stiffness = stiffness_;
  return result;
}

std::vector<std::array<int, 3>> PreparedTracker::triangles() const {
  std::vector<std::array<int, 3>> result;
  for (const Eigen::Vector3i& t : cell_->surface.triangles()) result.push_back({t[0], t[1], t[2]});
  return result;
}

std::vector<std::uint32_t> PreparedTracker::held() const {
  Eigen::Matrix3Xd rest, displaced;
  needle_.surface(rest, displaced);
  std::vector<std::uint32_t> result;
  for (Eigen::Index i = 0; i < rest.cols(); ++i) {
    const bool inside = rest.col(i).head<2>().norm() <= 1.001 * scene_.holding_pipette.contact_radius;
    if (rest(2, i) < 0 && inside) result.push_back(static_cast<std::uint32_t>(i));
  }
  return result;
}

CellUnderNeedle::Picture PreparedTracker::picture() const {
  Eigen::Matrix3Xd rest, displaced;
  needle_.surface(rest, displaced);
  Picture picture;
  for (Eigen::Index i = 0; i < rest.cols(); ++i) {
    picture.vertices.emplace_back(rest.col(i) + displaced.col(i));
    picture.displacement.push_back(displaced.col(i).norm());
  }
  return picture;
}

}  // namespace microinjection
