#include "cell/model/live_cell_model.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

namespace microinjection {

LiveCellModelConfig LiveCellModelConfig::read(ConfigReader& reader) {
  LiveCellModelConfig config;
  reader.number("prepare_distance", config.prepare_distance, Range::positive());
  reader.number("extrapolation_limit", config.extrapolation_limit, Range::positive());
  reader.number("solution_period", config.solution_period, Range::positive());
  return config;
}

LiveCellModel::LiveCellModel(std::shared_ptr<const LiveCell> cell, const LiveCellModelConfig& config)
    : cell_(std::move(cell)),
      rest_(cell_->undeformedSurface()),
      members_at_rest_(cell_->undeformedMembers()),
      config_(config),
      thread_(cell_) {
  invalid_reason_.reserve(200);
}

void LiveCellModel::request(double time, const Eigen::Vector3d& displacement) {
  TipMotion move{displacement, contacts_, std::nullopt, time};
  if (contact_) move.contact_start = contact_start_;
  bool accepted = thread_.request(contact_point_, move);
  while (!accepted && config_.fixed_period) accepted = thread_.request(contact_point_, move);
  if (!accepted) return;  // the next step requests it again
  request_pending_ = true;
  requested_at_ = time;
  contact_requested_ = true;
}

void LiveCellModel::receiveSolution(double time) {
  if (!request_pending_) return;
  std::shared_ptr<const CellSolution> solution;
  try {
    if (!config_.fixed_period) {
      solution = thread_.poll();
    } else if (time - requested_at_ >= config_.solution_period - 1e-9) {
      solution = thread_.wait();
    }
  } catch (const std::exception& error) {  // a contact that the solver refuses, for example on held vertices
    failure_ = error.what();
    request_pending_ = false;
    solution_.reset();
    return;
  }
  if (!solution) return;
  failure_.clear();
  request_pending_ = false;
  if (!solution->contact_point.sameAs(*contact_point_)) return;  // of an earlier contact point
  solution_ = std::move(solution);
  solution_time_ = requested_at_;
}

void LiveCellModel::prepare(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, const Eigen::Vector3d& touch,
                            double time) {
  if ((tip - touch).dot(axis) > config_.prepare_distance) return;
  const Scene::Needle& needle = cell_->scene().needle;
  const Eigen::Vector3d point = snapToNeedleLine(needle, touch);
  if (!contact_prepared_at_ || (point - *contact_prepared_at_).norm() > tremorAllowance(needle)) {
    contact_point_ = std::make_shared<ContactPoint>(cell_->contactAt(point, axis));
    contact_prepared_at_ = point;
    contact_requested_ = false;
    solution_.reset();
  }
  if (!contact_requested_ && !request_pending_) request(time, cell_->preparedDisplacement());
}

TipForce LiveCellModel::invalidForce(const char* reason) {
  invalid_reason_ = reason;
  return {false, Eigen::Vector3d::Zero()};
}

void LiveCellModel::release() {
  contact_.reset();
  ++contacts_;
  contact_requested_ = false;  // prepares the next contact in advance
  invalid_reason_.clear();
  shape_.write({});
}

TipForce LiveCellModel::contactForce(double time) {
  if (!request_pending_) request(time, contact_->displacement);
  if (!failure_.empty()) return invalidForce(failure_.c_str());
  if (!solution_) return invalidForce("the contact is still being prepared");
  const IndentationSolution& solved = solution_->indentation;
  if (!solved.converged) return invalidForce(solved.reason.c_str());
  const Eigen::Vector3d ahead = contact_->displacement - solved.tip_displacement;
  if (ahead.norm() > config_.extrapolation_limit) {
    char text[120];
    std::snprintf(text, sizeof(text), "the tip is %.6g m ahead of the last solution, allowed %.6g", ahead.norm(),
                  config_.extrapolation_limit);
    return invalidForce(text);
  }
  TipForce result;
  result.force = solved.force - solved.stiffness * ahead;
  return result;
}

TipForce LiveCellModel::step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) {
  const bool finite = tip.allFinite() && axis.allFinite() && std::isfinite(time);
  TipForce force = finite ? computeForce(tip, axis, time) : invalidForce("the needle's pose is not finite");
  shape_.write(contact_ ? Shape{solution_, contact_point_} : Shape{});
  return force;
}

TipForce LiveCellModel::computeForce(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) {
  invalid_reason_.clear();
  receiveSolution(time);
  if (!contact_) {
    const auto touch = cell_->touch(tip, axis, hint_);
    if (!touch) return {};
    prepare(tip, axis, *touch, time);
    if (cell_->isClear(tip, axis, *touch)) return {};
    contact_ = Contact{};
    contact_->contact_point = *touch;
    contact_start_ = time;
  }
  contact_->displacement = tip - contact_->contact_point;
  contact_->indentation = -contact_->displacement.dot(axis);
  const char* refusal = cell_->refusal(axis);
  TipForce result = refusal != nullptr ? invalidForce(refusal) : contactForce(time);
  const double push = result.force.dot(axis);
  if ((push <= 0 || !result.valid) && cell_->isClear(tip, axis, contact_->contact_point)) {
    release();
    return {};
  }
  if (push < 0) return {};  // there is no adhesion; the extrapolation pulls
  return result;
}

std::optional<CellModel::Solution> LiveCellModel::solution(double time) const {
  if (!solution_) return std::nullopt;
  const IndentationSolution& solved = solution_->indentation;
  return Solution{solved.stiffness, solved.newton_iterations, solved.cpu_time, time - solution_time_,
                  solved.smallest_jacobian};
}

std::vector<std::array<int, 3>> LiveCellModel::triangles() const { return rest_.triangles; }

std::vector<std::uint32_t> LiveCellModel::held() const { return rest_.held; }

CellModel::DeformedSurface LiveCellModel::deformedSurface() {
  shape_.update();
  const Shape& shape = shape_.value();
  DeformedSurface surface;
  for (std::size_t i = 0; i < rest_.vertices.size(); ++i) {
    Eigen::Vector3d moved = Eigen::Vector3d::Zero();
    if (shape.solution) moved = shape.solution->displacement.segment<3>(3 * i);
    const bool own_rest = shape.solution && shape.solution->rest;
    surface.at_rest.push_back(own_rest ? (*shape.solution->rest)[i] : rest_.vertices[i]);
    surface.vertices.emplace_back(surface.at_rest[i] + moved);
    surface.displacement.push_back(moved.norm());
  }
  surface.border_vertices = shape.solution ? shape.solution->border_vertices : rest_.border_vertices;
  surface.members = shape.solution ? shape.solution->members : members_at_rest_;
  if (shape.contact_point) surface.contact_vertices = cell_->onSurface(shape.contact_point->patch);
  return surface;
}

}  // namespace microinjection
