#include "nodes/cell_simulator_node.h"

#include <string>
#include <utility>

#include "base/errors.h"
#include "nodes/conversions.h"
#include "nodes/node_parameters.h"
#include "surrogate/prepared_tracker.h"

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

}  // namespace

const char* const CellSimulatorNode::kHelp =
    "cell_simulator: the finite-element cell under the needle.\n"
    "In: /needle/measured_cp. Out: /cell/predicted_cf, /cell/state.\n"
    "Parameters: ~scene (file, required), ~model (auto|prepared|live), ~rate (Hz), ~state_rate (Hz), ~needle_timeout "
    "(s), ~prepare_distance (m),\n"
    "~extrapolation_limit (m), ~solution_period (s, in lock step); see config/cell_simulator.yaml.\n";

CellSimulatorNode::Parameters CellSimulatorNode::Parameters::read(const ros::NodeHandle& private_node) {
  Parameters parameters;
  ConfigReader reader = parameterReader(private_node);
  reader.text("scene", parameters.scene, ConfigReader::kRequired);
  reader.choice("model", parameters.model, {"auto", "prepared", "live"});
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
  parameters_.tracker.fixed_period = cycle_.lockstep();
  cell_ = makeCell();
  undeformed_.header.frame_id = kCellFrame;
  for (const auto& triangle : cell_->triangles()) {
    undeformed_.triangles.insert(undeformed_.triangles.end(), triangle.begin(), triangle.end());
  }
  undeformed_.held_vertices = cell_->held();
  cycle_.diagnostics().add("solver", [this](auto& status) { report(status); });
}

/// Never another model than was asked for, and always said which.
std::unique_ptr<CellUnderNeedle> CellSimulatorNode::makeCell() const {
  const Scene scene = loadScene(parameters_.scene);
  if (parameters_.model != "live") {
    const PreparationRange range = PreparationRange::standard(scene);
    auto prepared = PreparedCell::load(scene, range, preparedFile(scene, Preparation::plan(scene, range)));
    if (prepared) {
      ROS_INFO("the cell is prepared: converged force, fitted to %.2g %% (median)", 100 * prepared->median_error);
      return std::make_unique<PreparedTracker>(scene, std::make_shared<const PreparedCell>(std::move(*prepared)));
    }
    const std::string call = "rosrun cell_microinjection prepare --scene " + parameters_.scene;
    if (parameters_.model == "prepared") {
      throw ConfigError("model = prepared: this cell and tip were not prepared; run: " + call);
    }
    ROS_WARN_STREAM("the cell is not prepared, so it is live: P1 tetrahedra, whose force is too large; run: " << call);
  }
  ROS_INFO_STREAM("meshing the cell of " << parameters_.scene);
  const auto cell = std::make_shared<const CellModel>(scene);
  ROS_INFO_STREAM("the cell has " << cell->mesh().vertices.size() << " vertices and " << cell->mesh().tetrahedra.size()
                                  << " tetrahedra");
  return std::make_unique<CellTracker>(cell, parameters_.tracker);
}

void CellSimulatorNode::run() {
  cycle_.run([this](const Cycle::Tick& tick) { step(tick); });
}

void CellSimulatorNode::step(const Cycle::Tick& tick) {
  TipForce force{false, Eigen::Vector3d::Zero()};
  const auto* message = needle_.get(tick.now);
  const auto pose = trustedPose(message);
  if (pose) {
    force = cell_->step(pose->translation(), pose->linear().col(2), tick.now.toSec());
    untrusted_ = cell_->distrust();
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
  const CellUnderNeedle::Picture picture = cell_->picture();
  state.vertices.resize(picture.vertices.size());
  for (std::size_t i = 0; i < picture.vertices.size(); ++i) {
    state.vertices[i].x = picture.vertices[i].x();
    state.vertices[i].y = picture.vertices[i].y();
    state.vertices[i].z = picture.vertices[i].z();
  }
  state.displacement.assign(picture.displacement.begin(), picture.displacement.end());
  state.contact_vertices = picture.touched;
}

void CellSimulatorNode::publishState(const ros::Time& now, const TipForce& force) {
  cell_microinjection::CellState state = undeformed_;
  state.header.stamp = now;
  fillSurface(state);
  if (const auto& contact = cell_->contact()) {
    state.in_contact = true;
    state.indentation = contact->indentation;
    state.tip_displacement = toVector(contact->displacement);
  }
  state.force = toVector(force.force);
  state.punctured = cell_->punctured();
  state.converged = untrusted_.empty();
  state.reason = untrusted_;
  state.smallest_jacobian = 1;
  if (const auto solution = cell_->solution(now.toSec())) {
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(state.contact_stiffness.data()) = solution->stiffness;
    state.newton_iterations = solution->newton_iterations;
    state.solve_time = solution->cpu_time;
    state.solution_age = solution->age;
    state.smallest_jacobian = solution->smallest_jacobian;
  }
  state_.publish(state);
  state_sent_ = now;
}

void CellSimulatorNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const bool good = untrusted_.empty();
  status.summary(good ? diagnostic_msgs::DiagnosticStatus::OK : diagnostic_msgs::DiagnosticStatus::WARN,
                 good ? (cell_->punctured() ? "punctured"
                         : cell_->contact() ? "in contact"
                                            : "free")
                      : untrusted_);
  if (const auto solution = cell_->solution(ros::Time::now().toSec())) {
    status.add("Newton iterations", solution->newton_iterations);
    status.add("solution time (s of CPU)", solution->cpu_time);
    status.add("smallest det F", solution->smallest_jacobian);
  }
}

}  // namespace microinjection
