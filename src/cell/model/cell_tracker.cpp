#include "cell/model/cell_tracker.h"

#include <algorithm>
#include <cmath>
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
    : cell_(std::move(cell)),
      rest_(cell_->surfaceAtRest()),
      members_at_rest_(cell_->membersAtRest()),
      config_(config),
      thread_(cell_) {
  distrust_.reserve(200);
}

void CellTracker::ask(double time, const Eigen::Vector3d& displacement) {
  TipMove move{displacement, contacts_, std::nullopt, time};
  if (contact_) move.touched = touched_;
  bool asked = thread_.ask(place_, move);
  while (!asked && config_.fixed_period) asked = thread_.ask(place_, move);
  if (!asked) return;  // with the next step, then
  asked_ = true;
  asked_at_ = time;
  place_asked_ = true;
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
  if (!solution->place.sameAs(*place_)) return;  // the needle has moved on to another place
  solution_ = std::move(solution);
  solution_time_ = asked_at_;
}

void CellTracker::prepare(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, const Eigen::Vector3d& touch,
                          double time) {
  if ((tip - touch).dot(axis) > config_.prepare_distance) return;
  // A hand trembles: a tenth of the tip's radius makes no other contact, and near the scene's line, where the mesh has
  // the tip's circle, that circle is meant.
  const Scene::Needle& needle = cell_->scene().needle;
  const double tremble = 0.1 * needle.tip.radius;
  Eigen::Vector3d point = touch;
  if ((point.head<2>() - needle.offset).norm() < tremble) point.head<2>() = needle.offset;
  if (!placed_at_ || (point - *placed_at_).norm() > tremble) {
    place_ = std::make_shared<TipPlace>(cell_->placeAt(point, axis));
    placed_at_ = point;
    place_asked_ = false;
    solution_.reset();
  }
  if (!place_asked_ && !asked_) ask(time, cell_->preparedDisplacement());
}

TipForce CellTracker::distrustBecause(const char* reason) {
  distrust_ = reason;
  return {false, Eigen::Vector3d::Zero()};
}

void CellTracker::release() {
  contact_.reset();
  ++contacts_;
  place_asked_ = false;  // prepares the contact before the next touch
  distrust_.clear();
  shape_.write({});
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
  const bool known = tip.allFinite() && axis.allFinite() && std::isfinite(time);
  TipForce force = known ? answer(tip, axis, time) : distrustBecause("the needle's pose is not finite");
  shape_.write(contact_ ? Shape{solution_, place_} : Shape{});
  return force;
}

TipForce CellTracker::answer(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) {
  distrust_.clear();
  collect(time);
  if (!contact_) {
    const auto touch = cell_->touch(tip, axis, hint_);
    if (!touch) return {};
    prepare(tip, axis, *touch, time);
    if (cell_->isOff(tip, axis, *touch)) return {};
    contact_ = Contact{};
    contact_->touched_at = *touch;
    touched_ = time;
  }
  contact_->displacement = tip - contact_->touched_at;
  contact_->indentation = -contact_->displacement.dot(axis);
  const char* refusal = cell_->refusal(axis);
  TipForce result = refusal != nullptr ? distrustBecause(refusal) : touchForce(time);
  const double push = result.force.dot(axis);
  if ((push <= 0 || !result.trusted) && cell_->isOff(tip, axis, contact_->touched_at)) {
    release();
    return {};
  }
  if (push < 0) return {};  // there is no adhesion; what pulls is the extrapolation
  return result;
}

std::optional<CellUnderNeedle::Solution> CellTracker::solution(double time) const {
  if (!solution_) return std::nullopt;
  const IndentationSolution& solved = solution_->indentation;
  return Solution{solved.stiffness, solved.newton_iterations, solved.cpu_time, time - solution_time_,
                  solved.smallest_jacobian};
}

std::vector<std::array<int, 3>> CellTracker::triangles() const { return rest_.triangles; }

std::vector<std::uint32_t> CellTracker::held() const { return rest_.held; }

CellUnderNeedle::Picture CellTracker::picture() {
  shape_.update();
  const Shape& shape = shape_.value();
  Picture picture;
  for (std::size_t i = 0; i < rest_.vertices.size(); ++i) {
    Eigen::Vector3d moved = Eigen::Vector3d::Zero();
    if (shape.solution) moved = shape.solution->displacement.segment<3>(3 * i);
    const bool own = shape.solution && shape.solution->rest;
    picture.vertices.emplace_back((own ? (*shape.solution->rest)[i] : rest_.vertices[i]) + moved);
    picture.displacement.push_back(moved.norm());
  }
  picture.members = shape.solution ? shape.solution->members : members_at_rest_;
  if (shape.touched) picture.touched = cell_->onSurface(shape.touched->patch);
  return picture;
}

}  // namespace microinjection
