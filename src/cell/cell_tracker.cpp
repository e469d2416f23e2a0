#include "cell/cell_tracker.h"

#include <algorithm>
#include <cstdio>
#include <exception>

namespace microinjection {

CellTrackerConfig CellTrackerConfig::read(ConfigReader& reader) {
  CellTrackerConfig config;
  reader.number("prepare_distance", config.prepare_distance, Range::positive());
  reader.number("extrapolation_limit", config.extrapolation_limit, Range::positive());
  reader.number("solution_period", config.solution_period, Range::positive());
  return config;
}

CellTracker::CellTracker(std::shared_ptr<const LiveCell> cell, const CellTrackerConfig& config)
    : cell_(std::move(cell)), config_(config), thread_(cell_), members_at_rest_(cell_->membersAtRest()) {
  distrust_.reserve(200);
}

void CellTracker::ask(double time, const Eigen::Vector3d& displacement) {
  bool asked = thread_.ask(patch_, displacement, time);
  while (!asked && config_.fixed_period) asked = thread_.ask(patch_, displacement, time);
  if (!asked) return;  // with the next step, then
  asked_ = true;
  asked_at_ = time;
  patch_asked_ = true;
}

void CellTracker::collect(double time) {
  if (!asked_) return;
  std::shared_ptr<const CellSolution> solution;
  try {
    if (!config_.fixed_period) {
      solution = thread_.take();
    } else if (time - asked_at_ >= config_.solution_period - 1e-9) {
      solution = thread_.wait();
    }
  } catch (const std::exception& error) {  // a contact that the solver refuses, as on the held vertices
    failure_ = error.what();
    asked_ = false;
    solution_.reset();
    return;
  }
  if (!solution) return;
  failure_.clear();
  asked_ = false;
  if (solution->patch.vertices != patch_->vertices) return;  // the needle has moved on to another place
  solution_ = std::move(solution);
  solution_time_ = asked_at_;
}

void CellTracker::prepare(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, const SurfaceHit& hit, double time) {
  if ((tip - hit.point).dot(axis) > config_.prepare_distance) return;
  // A hand trembles: a tenth of the tip's radius makes no other contact, and near the scene's line, where the mesh has
  // the tip's circle, that circle is meant.
  const Scene::Needle& needle = cell_->scene().needle;
  const double tremble = 0.1 * needle.tip.radius;
  Eigen::Vector3d point = hit.point;
  if ((point.head<2>() - needle.offset).norm() < tremble) point.head<2>() = needle.offset;
  if (patch_->vertices.empty() || (point - patch_at_).norm() > tremble) {
    patch_ = std::make_shared<TipPatch>(cell_->patchAt(point, axis));
    patch_at_ = point;
    patch_asked_ = false;
    solution_.reset();
  }
  if (!patch_asked_ && !asked_) ask(time, Eigen::Vector3d::Zero());
}

TipForce CellTracker::distrustBecause(const char* reason) {
  distrust_ = reason;
  return {false, Eigen::Vector3d::Zero()};
}

void CellTracker::release() {
  contact_.reset();
  patch_asked_ = false;  // asks for the contact at zero displacement before the next touch
}

TipForce CellTracker::touchForce(double time) {
  if (!asked_) ask(time, contact_->displacement);
  if (!failure_.empty()) return distrustBecause(failure_.c_str());
  if (!solution_) return distrustBecause("the contact is still being prepared");
  const IndentationSolution& solved = solution_->indentation;
  if (!solved.converged) return distrustBecause(solved.reason.c_str());
  const Eigen::Vector3d ahead = contact_->displacement - solved.tip_displacement;
  if (ahead.norm() > config_.extrapolation_limit) {
    char text[120];
    std::snprintf(text, sizeof(text), "the tip is %.6g m ahead of the last solution, allowed %.6g", ahead.norm(),
                  config_.extrapolation_limit);
    return distrustBecause(text);
  }
  TipForce result;
  result.force = solved.force - solved.stiffness * ahead;
  return result;
}

TipForce CellTracker::step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) {
  TipForce force = answer(tip, axis, time);
  shape_.write(contact_ ? Shape{solution_, patch_} : Shape{});
  return force;
}

TipForce CellTracker::answer(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) {
  distrust_.clear();
  collect(time);
  if (punctured_) return {};
  if (!contact_) {
    const double outside = 2 * cell_->scene().cell.diameter();
    const Eigen::Vector3d origin = tip + (outside + tip.norm()) * axis;  // from outside, wherever the tip is
    const auto hit = cell_->hit(origin, -axis, start_triangle_);
    if (!hit) return {};
    start_triangle_ = hit->triangle;
    prepare(tip, axis, *hit, time);
    if ((tip - hit->point).dot(axis) > 0) return {};
    contact_ = Contact{};
    contact_->touched_at = hit->point;
  }
  contact_->displacement = tip - contact_->touched_at;
  contact_->indentation = -contact_->displacement.dot(axis);
  TipForce result = touchForce(time);
  const double push = result.force.dot(axis);
  if (contact_->indentation < 0 && (push <= 0 || !result.trusted)) {
    release();
    return {};
  }
  if (push < 0) return {};  // there is no adhesion; what pulls is the extrapolation
  if (push >= cell_->scene().cell.puncture_force) {
    punctured_ = true;
    release();
    return {};
  }
  return result;
}

std::optional<CellUnderNeedle::Solution> CellTracker::solution(double time) const {
  if (!solution_) return std::nullopt;
  const IndentationSolution& solved = solution_->indentation;
  return Solution{solved.stiffness, solved.newton_iterations, solved.cpu_time, time - solution_time_,
                  solved.smallest_jacobian};
}

std::vector<std::array<int, 3>> CellTracker::triangles() const { return cell_->surface().triangles; }

std::vector<std::uint32_t> CellTracker::onSurface(const std::vector<int>& mesh_vertices) const {
  const SurfaceMesh& surface = cell_->surface();
  std::vector<std::uint32_t> result;
  for (const int vertex : mesh_vertices) {
    const auto found = std::lower_bound(surface.mesh_vertices.begin(), surface.mesh_vertices.end(), vertex);
    if (found != surface.mesh_vertices.end() && *found == vertex)
      result.push_back(static_cast<std::uint32_t>(found - surface.mesh_vertices.begin()));
  }
  return result;
}

std::vector<std::uint32_t> CellTracker::held() const { return onSurface(cell_->heldVertices()); }

CellUnderNeedle::Picture CellTracker::picture() {
  const SurfaceMesh& surface = cell_->surface();
  shape_.update();
  const Shape& shape = shape_.value();
  Picture picture;
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    Eigen::Vector3d moved = Eigen::Vector3d::Zero();
    if (shape.solution) moved = shape.solution->displacement.segment<3>(3 * surface.mesh_vertices[i]);
    picture.vertices.emplace_back(surface.vertices[i] + moved);
    picture.displacement.push_back(moved.norm());
  }
  picture.members = shape.solution ? shape.solution->members : members_at_rest_;
  if (shape.touched) picture.touched = onSurface(shape.touched->vertices);
  return picture;
}

}  // namespace microinjection
