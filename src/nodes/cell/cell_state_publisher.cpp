#include "nodes/cell/cell_state_publisher.h"

#include <algorithm>
#include <chrono>

#include "cell/material/material_parameter.h"
#include "cell/model/cell_parameters.h"
#include "cell/model/touching_vertices.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/real_time.h"

namespace microinjection {
namespace {

constexpr char kCellFrame[] = "cell";

std::vector<geometry_msgs::Point32> toPoints(const std::vector<Eigen::Vector3d>& vertices) {
  std::vector<geometry_msgs::Point32> points(vertices.size());
  std::transform(vertices.begin(), vertices.end(), points.begin(),
                 [](const Eigen::Vector3d& vertex) { return toMessage<geometry_msgs::Point32>(vertex); });
  return points;
}

void fillCell(const Scene& scene, cell_microinjection::CellState& state) {
  for (const CellParameter& parameter : cellParameters(scene)) {
    state.parameter_names.push_back(parameter.name);
    state.parameter_values.push_back(parameter.value);
  }
  state.layer_radii = scene.cell.outerRadii();
  if (scene.cell.tensegrity) return;
  const MaterialConfig& material = scene.cell.material();
  state.material = material.model;
  for (const MaterialParameter& each : materialParameters()) {
    if (each.model != material.model) continue;
    state.parameter_names.emplace_back(each.name);
    state.parameter_values.push_back(material.*each.value);
  }
}

}  // namespace

void CellMoment::setReason(const std::string& text) {
  valid = text.empty();
  const std::size_t length = std::min(text.size(), reason.size() - 1);
  std::copy_n(text.begin(), length, reason.begin());
  reason[length] = '\0';
}

CellStatePublisher::CellStatePublisher(PlacedCell& cell, const Scene& scene,
                                       Output<cell_microinjection::CellState>& output, double rate, Thread thread)
    : cell_(cell), scene_(scene), output_(output), period_(1 / rate) {
  undeformed_.header.frame_id = kCellFrame;
  for (const auto& triangle : cell_.triangles()) {
    undeformed_.triangles.insert(undeformed_.triangles.end(), triangle.begin(), triangle.end());
  }
  for (const CellModel::BorderTriangle& triangle : cell_.borders()) {
    undeformed_.border_triangles.insert(undeformed_.border_triangles.end(), triangle.vertices.begin(),
                                        triangle.vertices.end());
    undeformed_.border_layers.push_back(static_cast<std::uint32_t>(triangle.layer));
  }
  undeformed_.held_vertices = cell_.held();
  undeformed_.layers = cell_.layers();
  if (thread == Thread::kOwn) thread_ = std::thread([this] { run(); });
}

CellStatePublisher::~CellStatePublisher() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void CellStatePublisher::step(const CellMoment& moment) {
  if (thread_.joinable()) {
    moment_.write(moment);
  } else if (isDue(sent_, moment.now, period_)) {
    publish(moment);
    sent_ = moment.now;
  }
}

void CellStatePublisher::run() {
  preferForThread(Priority::kOrdinary);
  auto due = std::chrono::steady_clock::now();
  const auto period =
      std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(period_));
  while (!stop_) {
    due = std::max(due + period, std::chrono::steady_clock::now());  // after a stall: do not catch up
    std::this_thread::sleep_until(due);
    if (moment_.update()) publish(moment_.value());
  }
}

void CellStatePublisher::fillSurface(const CellMoment& moment, cell_microinjection::CellState& state) {
  const CellModel::DeformedSurface picture = cell_.deformedSurface();
  const Scene& scene = picture.scene ? *picture.scene : scene_;
  state.vertices = toPoints(picture.vertices);
  state.rest_vertices = toPoints(picture.at_rest);
  state.border_vertices = toPoints(picture.border_vertices);
  state.displacement.assign(picture.displacement.begin(), picture.displacement.end());
  state.contact_vertices = picture.contact_vertices;
  if (moment.contact && state.contact_vertices.empty() && !moment.insertion.inside) {
    const Eigen::Vector3d tip = moment.contact->contact_point + moment.contact->displacement;
    state.contact_vertices = touchingVertices(scene.needle.tip, tip, picture.vertices);
  }
  fillCell(scene, state);
  state.parameter_names.push_back(PlacedCell::kName);
  state.parameter_values.push_back(cell_.height());
  for (const Eigen::Vector3d& hole : picture.holes) state.holes.push_back(toMessage<geometry_msgs::Point>(hole));
  for (const CellModel::Member& member : picture.members) {
    state.member_points.push_back(toMessage<geometry_msgs::Point32>(member.from));
    state.member_points.push_back(toMessage<geometry_msgs::Point32>(member.to));
    state.member_force.push_back(static_cast<float>(member.force));
    state.member_kind.push_back(static_cast<std::uint8_t>(member.kind));
  }
}

void CellStatePublisher::publish(const CellMoment& moment) {
  cell_microinjection::CellState state = undeformed_;
  state.header.stamp = moment.now;
  fillSurface(moment, state);
  if (moment.contact) {
    state.in_contact = true;
    state.contact_point = toMessage<geometry_msgs::Point>(moment.contact->contact_point);
    state.indentation = moment.contact->indentation;
    state.tip_displacement = toMessage<geometry_msgs::Vector3>(moment.contact->displacement);
  }
  state.force = toMessage<geometry_msgs::Vector3>(moment.force.force);
  state.force_error = moment.force_error.value_or(-1);
  state.punctured = moment.insertion.punctured;
  state.layers_punctured = static_cast<std::uint32_t>(moment.insertion.layers_punctured);
  state.inside = moment.insertion.inside;
  state.insertion_depth = moment.insertion.depth;
  state.converged = moment.valid;
  state.reason = moment.reason.data();
  state.smallest_jacobian = 1;
  if (moment.solution) {
    const CellModel::Solution& solution = *moment.solution;
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(state.contact_stiffness.data()) = solution.stiffness;
    state.newton_iterations = solution.newton_iterations;
    state.solve_time = solution.cpu_time;
    state.solution_age = solution.age;
    state.smallest_jacobian = solution.smallest_jacobian;
  }
  output_.publish(state);
}

}  // namespace microinjection
