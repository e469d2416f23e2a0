#include "nodes/cell_simulator_node.h"

#include <cmath>

#include "nodes/runtime/conversions.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {
namespace {

constexpr double kContactPeriod = 0.02;   ///< s, of /cell/contact without a change
constexpr double kBorePeriod = 0.005;     ///< s
constexpr double kInjectorTimeout = 0.1;  ///< s, past which there is no suction

}  // namespace

const char* const CellSimulatorNode::kHelp =
    "cell_simulator: the finite-element cell under the needle.\n"
    "In: /needle/measured_cp or /needle/true_cp, /needle/piezo_pulses, /cell/set_parameters, of a needle with a bore\n"
    "/injector/state, with a holder /holder/state and /holder_rig/measured_cp or true_cp. Out: /cell/predicted_cf, "
    "/cell/contact, /cell/state, of a "
    "needle with a bore\n"
    "/cell/bore, with a holder /cell/hold and /cell/seal.\n"
    "Service: ~set_cell_parameters.\n";

CellSimulatorNode::Parameters CellSimulatorNode::Parameters::read(const Bus& bus) {
  Parameters parameters;
  ConfigReader reader = parameterReader(bus);
  reader.path("scene", parameters.scene, ConfigReader::kRequired);
  reader.choice("model", parameters.model, {"auto", "surrogate", "live", "explicit"});
  reader.path("families", parameters.models.families);
  reader.choice("needle", parameters.needle, {"measured", "true"});
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  reader.number("state_rate", parameters.state_rate, {0, 100, true, false});
  reader.number("needle_timeout", parameters.needle_timeout, Range::positive());
  parameters.models.live = LiveCellModelConfig::read(reader);
  parameters.models.explicit_dynamics = ExplicitCellModelConfig::read(reader);
  parameters.holding = CellHolding::Config::read(reader);
  reader.finish();
  return parameters;
}

CellSimulatorNode::CellSimulatorNode(Bus& bus)
    : parameters_(Parameters::read(bus)),
      cycle_(bus, parameters_.rate),
      needle_(cycle_.input<geometry_msgs::PoseStamped>("needle/" + parameters_.needle + "_cp", InputPhase::kDrives,
                                                       parameters_.needle_timeout)),
      force_(cycle_.output<geometry_msgs::WrenchStamped>("cell/predicted_cf")),
      contact_(cycle_.output<cell_microinjection::CellContact>("cell/contact")),
      state_(cycle_.output<cell_microinjection::CellState>("cell/state", true)) {
  parameters_.models.live.fixed_period = cycle_.bus().isVirtual();
  parameters_.models.tell = [](const std::string& text) { ROS_INFO_STREAM(text); };
  const Scene scene = loadScene(parameters_.scene);
  chosen_ = makeCell(scene);
  cell_ = std::make_unique<PlacedCell>(*chosen_.cell);
  invalid_reason_.reserve(200);  // no allocation in a step
  can_be_punctured_ = !cell_->layers().empty();
  if (cell_->bore()) {
    injector_ =
        &cycle_.input<cell_microinjection::InjectorState>("injector/state", InputPhase::kSampled, kInjectorTimeout);
    bore_ = &cycle_.output<cell_microinjection::BoreState>("cell/bore");
  }
  if (can_be_punctured_) piezo_.emplace(cycle_.bus());
  if (parameters_.holding.holder) makeHolding(scene);
  using Thread = CellStatePublisher::Thread;
  const auto thread = cycle_.bus().isVirtual() ? Thread::kOfTheStep : Thread::kOwn;
  state_publisher_ = std::make_unique<CellStatePublisher>(*cell_, scene, state_, parameters_.state_rate, thread);
  parameter_server_ =
      std::make_unique<CellParameterServer>(chosen_.change.get(), chosen_.unchangeable, *cell_, scene.radius(), cycle_);
  cycle_.diagnostics().add("solver", [this](auto& status) { report(status); });
  cycle_.onStep([this](const Cycle::Tick& tick) { step(tick); });
}

ChosenCellModel CellSimulatorNode::makeCell(const Scene& scene) const {
  ChosenCellModel served = makeCellModel(scene, parameters_.model, parameters_.models, parameters_.scene);
  if (served.as_required) {
    ROS_INFO_STREAM(served.description);
  } else {
    ROS_WARN_STREAM(served.description);
  }
  return served;
}

void CellSimulatorNode::makeHolding(const Scene& scene) {
  const std::string refusal = CellHolding::refusal(scene);
  if (refusal.empty()) {
    holding_ = std::make_unique<CellHolding>(cycle_, scene, parameters_.holding, parameters_.models.families);
  } else {
    ROS_INFO_STREAM("the holder does not act on the cell: " << refusal);
  }
}

void CellSimulatorNode::step(const Cycle::Tick& tick) {
  TipForce force{false, Eigen::Vector3d::Zero()};
  const auto* message = needle_.get(tick.now);
  const auto pose = validPose(message);
  if (bore_) readInjector(tick.now);
  if (holding_) {
    std::optional<Eigen::Isometry3d> needle = pose;
    if (needle) needle->translation().z() -= cell_->height();  // which CellHold does not know
    cell_->follow(holding_->step(tick, needle, cell_->insertion().inside));
  }
  const std::optional<PiezoPulse> pulse = piezo_ ? piezo_->due(tick.now) : std::nullopt;
  if (pulse && pose) cell_->strike(*pulse);
  if (pose) {
    force = cell_->step(pose->translation(), pose->linear().col(2), tick.now.toSec());
    if (holding_) force.force = holding_->forceOnNeedle(force.force);
    invalid_reason_ = cell_->invalidReason();
  } else {
    invalid_reason_ = "no valid needle pose";
  }
  const ros::Time stamp = message ? message->header.stamp : tick.now;
  const auto wrench = toWrench(force.force, stamp, kWorldFrame);
  if (force.valid) {
    force_.publish(wrench);
  } else {
    force_.publishInvalid(wrench);
  }
  publishContact(tick.now);
  if (bore_ && pose) publishBore(tick.now);
  if (holding_) holding_->publish(tick.now);
  state_publisher_->step(moment(tick.now, force));
}

void CellSimulatorNode::publishContact(const ros::Time& now) {
  cell_microinjection::CellContact contact;
  contact.in_contact = cell_->contact().has_value();
  contact.inside = cell_->insertion().inside;
  contact.can_be_punctured = can_be_punctured_;
  const bool same = contact.in_contact == last_contact_.in_contact && contact.inside == last_contact_.inside;
  if (same && !isDue(last_contact_.header.stamp, now, kContactPeriod)) return;
  contact.header.stamp = now;
  contact_.publish(contact);
  last_contact_ = contact;
}

/// Without a valid state of the injector there is no suction.
void CellSimulatorNode::readInjector(const ros::Time& now) {
  const auto* injector = injector_->get(now);
  const bool valid = injector && std::isfinite(injector->rest_pressure - injector->pressure) &&
                     std::isfinite(injector->resistance) && injector->resistance > 0;
  CellModel::BoreLine line;
  if (valid) line = {injector->rest_pressure - injector->pressure, injector->resistance};
  cell_->setBoreLine(line);
}

void CellSimulatorNode::publishBore(const ros::Time& now) {
  if (!isDue(bore_published_, now, kBorePeriod)) return;
  const CellModel::Bore& bore = *cell_->bore();
  const double passed = bore_published_.isZero() ? 0 : secondsBetween(bore_published_, now);
  const double drawn = bore.volume - std::exchange(bore_volume_, bore.volume);
  bore_published_ = now;
  cell_microinjection::BoreState state;
  state.header.stamp = now;
  state.covered = bore.covered;
  state.length = bore.length;
  state.volume = bore.volume;
  // The mean since the last message, so that what the injector adds up is the volume in the bore.
  state.flow = bore.covered && bore.volume > 0 && passed > 0 ? drawn / passed : bore.flow;
  state.suction = bore.suction;
  state.tension = bore.tension;
  bore_->publish(state);
}

/// In virtual time without its processor time, which differs in each run.
std::optional<CellModel::Solution> CellSimulatorNode::solution(const ros::Time& now) const {
  auto solution = cell_->solution(now.toSec());
  if (solution && cycle_.bus().isVirtual()) solution->cpu_time = 0;
  return solution;
}

CellMoment CellSimulatorNode::moment(const ros::Time& now, const TipForce& force) const {
  CellMoment moment;
  moment.now = now;
  moment.force = force;
  moment.contact = cell_->contact();
  moment.solution = solution(now);
  moment.force_error = cell_->forceError();
  moment.insertion = cell_->insertion();
  moment.setReason(invalid_reason_);
  return moment;
}

void CellSimulatorNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const bool good = invalid_reason_.empty();
  status.summary(good ? diagnostic_msgs::DiagnosticStatus::OK : diagnostic_msgs::DiagnosticStatus::WARN,
                 good ? (cell_->insertion().inside ? "punctured"
                         : cell_->contact()        ? "in contact"
                                                   : "free")
                      : invalid_reason_);
  // It has measured times of the models, which differ in each run.
  if (!cycle_.bus().isVirtual()) status.add("served cell", chosen_.description);
  if (const auto solved = solution(cycle_.bus().now())) {
    status.add("Newton iterations", solved->newton_iterations);
    status.add("solution time (s of CPU)", solved->cpu_time);
    status.add("smallest det F", solved->smallest_jacobian);
  }
}

}  // namespace microinjection
