#include "nodes/cell_simulator_node.h"

#include <algorithm>
#include <vector>

#include "nodes/conversions.h"
#include "nodes/node_parameters.h"

namespace microinjection {
namespace {

constexpr char kCellFrame[] = "cell";

geometry_msgs::Vector3 toVector(const Eigen::Vector3d& vector) {
  geometry_msgs::Vector3 message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

/// Index of each held mesh vertex on the surface.
std::vector<std::uint32_t> onSurface(const SurfaceMesh& surface, const std::vector<int>& mesh_vertices) {
  std::vector<std::uint32_t> result;
  for (const int vertex : mesh_vertices) {
    const auto found = std::lower_bound(surface.mesh_vertices.begin(), surface.mesh_vertices.end(), vertex);
    if (found != surface.mesh_vertices.end() && *found == vertex)
      result.push_back(found - surface.mesh_vertices.begin());
  }
  return result;
}

}  // namespace

const char* const CellSimulatorNode::kHelp =
    "cell_simulator: the finite-element cell under the needle.\n"
    "In: /needle/measured_cp. Out: /cell/predicted_cf, /cell/state.\n"
    "Parameters: ~scene (file, required), ~rate (Hz), ~state_rate (Hz), ~needle_timeout (s), ~prepare_distance (m),\n"
    "~extrapolation_limit (m), ~solution_period (s, in lock step); see config/cell_simulator.yaml.\n";

CellSimulatorNode::Parameters CellSimulatorNode::Parameters::read(const ros::NodeHandle& private_node) {
  Parameters parameters;
  ConfigReader reader = parameterReader(private_node);
  reader.text("scene", parameters.scene, ConfigReader::kRequired);
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  reader.number("state_rate", parameters.state_rate, {0, 100, true, false});
  reader.number("needle_timeout", parameters.needle_timeout, Range::positive());
  parameters.tracker = CellTrackerConfig::read(reader);
  reader.finish();
  return parameters;
}

CellSimulatorNode::CellSimulatorNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : parameters_(Parameters::read(private_node)),
      cycle_(node, parameters_.rate),
      needle_(
          cycle_.input<geometry_msgs::PoseStamped>("needle/measured_cp", Phase::kSameTick, parameters_.needle_timeout)),
      force_(cycle_.output<geometry_msgs::WrenchStamped>("cell/predicted_cf")),
      state_(cycle_.output<cell_microinjection::CellState>("cell/state", true)) {
  const Scene scene = loadScene(parameters_.scene);
  ROS_INFO_STREAM("meshing the cell of " << parameters_.scene);
  cell_ = std::make_shared<const CellModel>(scene);
  ROS_INFO_STREAM("the cell has " << cell_->mesh().vertices.size() << " vertices and "
                                  << cell_->mesh().tetrahedra.size() << " tetrahedra");
  parameters_.tracker.fixed_period = cycle_.lockstep();
  tracker_ = std::make_unique<CellTracker>(cell_, parameters_.tracker);
  undeformed_.header.frame_id = kCellFrame;
  for (const auto& triangle : cell_->surface().triangles) {
    undeformed_.triangles.insert(undeformed_.triangles.end(), triangle.begin(), triangle.end());
  }
  undeformed_.held_vertices = onSurface(cell_->surface(), cell_->heldVertices());
  cycle_.diagnostics().add("solver", [this](auto& status) { report(status); });
}

void CellSimulatorNode::run() {
  cycle_.run([this](const Cycle::Tick& tick) { step(tick); });
}

void CellSimulatorNode::step(const Cycle::Tick& tick) {
  TipForce force{false, Eigen::Vector3d::Zero()};
  const auto* message = needle_.get(tick.now);
  const auto pose = trustedPose(message);
  if (pose) {
    force = tracker_->step(pose->translation(), pose->linear().col(2), tick.now.toSec());
    untrusted_ = tracker_->distrust();
  } else {
    untrusted_ = "no trusted needle pose";
  }
  const ros::Time stamp = message ? message->header.stamp : tick.now;
  const auto wrench = toWrench(force.force, stamp, kWorldFrame);
  if (force.trusted) {
    force_.publish(wrench);
  } else {
    force_.publishInvalid(wrench);
  }
  if ((tick.now - state_sent_).toSec() >= 1 / parameters_.state_rate) publishState(tick.now, force);
}

void CellSimulatorNode::fillSurface(cell_microinjection::CellState& state) const {
  const SurfaceMesh& surface = cell_->surface();
  const auto& solution = tracker_->solution();
  const bool deformed = tracker_->contact() && solution;
  state.vertices.resize(surface.vertices.size());
  state.displacement.resize(surface.vertices.size());
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    Eigen::Vector3d moved = Eigen::Vector3d::Zero();
    if (deformed) moved = solution->displacement.segment<3>(3 * surface.mesh_vertices[i]);
    const Eigen::Vector3d at = surface.vertices[i] + moved;
    state.vertices[i].x = at.x();
    state.vertices[i].y = at.y();
    state.vertices[i].z = at.z();
    state.displacement[i] = moved.norm();
  }
}

void CellSimulatorNode::publishState(const ros::Time& now, const TipForce& force) {
  cell_microinjection::CellState state = undeformed_;
  state.header.stamp = now;
  fillSurface(state);
  if (const auto& contact = tracker_->contact()) {
    state.in_contact = true;
    state.indentation = contact->indentation;
    state.tip_displacement = toVector(contact->displacement);
    state.contact_vertices = onSurface(cell_->surface(), tracker_->patch().vertices);
  }
  state.force = toVector(force.force);
  state.punctured = tracker_->punctured();
  state.converged = untrusted_.empty();
  state.reason = untrusted_;
  state.smallest_jacobian = 1;
  if (const auto& solution = tracker_->solution()) {
    const IndentationSolution& solved = solution->indentation;
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(state.contact_stiffness.data()) = solved.stiffness;
    state.newton_iterations = solved.newton_iterations;
    state.solve_time = solved.cpu_time;
    state.solution_age = tracker_->solutionAge(now.toSec());
    state.smallest_jacobian = solved.smallest_jacobian;
  }
  state_.publish(state);
  state_sent_ = now;
}

void CellSimulatorNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const bool good = untrusted_.empty();
  status.summary(good ? diagnostic_msgs::DiagnosticStatus::OK : diagnostic_msgs::DiagnosticStatus::WARN,
                 good ? (tracker_->punctured() ? "punctured"
                         : tracker_->contact() ? "in contact"
                                               : "free")
                      : untrusted_);
  if (const auto& solution = tracker_->solution()) {
    status.add("Newton iterations", solution->indentation.newton_iterations);
    status.add("solution time (s of CPU)", solution->indentation.cpu_time);
    status.add("smallest det F", solution->indentation.smallest_jacobian);
  }
}

}  // namespace microinjection
