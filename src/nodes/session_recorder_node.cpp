#include "nodes/session_recorder_node.h"

#include <tf2_msgs/TFMessage.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "base/atomic_file.h"
#include "base/worker_processes.h"
#include "cell_microinjection/CellHold.h"
#include "cell_microinjection/HolderState.h"
#include "cell_microinjection/OperatingState.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr double kRecorderRate = 100;                     // Hz, live
constexpr Nanoseconds kMaxDelay = 2000000000;             // largest delay of a message
constexpr Nanoseconds kMaxDelayInVirtualTime = 50000000;  // none is late, but the cell has its own rate for contacts

Nanoseconds stampOf(const ros::Time& time) { return static_cast<Nanoseconds>(time.toNSec()); }

template <typename Message>
Nanoseconds stampOf(const Message& message) {
  return stampOf(message.header.stamp);
}

/// Puts a force into its timeline; one with stamp 0 is invalid (CRTK) and withdraws the last.
template <typename Message, typename Value>
void putForce(const Message& message, const std::optional<Value>& value, Timeline<Value>& line) {
  if (value && !message.header.stamp.isZero()) {
    line.put(stampOf(message), value);
  } else {
    line.withdraw();
  }
}

void writeIntervals(std::ostream& out, const std::string& name, const IntervalHistogram& intervals) {
  out << name << ": {count: " << intervals.count() << ", median_ms: " << 1e3 * intervals.quantile(0.5)
      << ", p99_ms: " << 1e3 * intervals.quantile(0.99) << ", max_ms: " << 1e3 * intervals.largest() << "}\n";
}

}  // namespace

const char* const SessionRecorderNode::kHelp =
    "session_recorder: writes force_depth.csv, summary.yaml and session.bag of a session. While it runs, its rows and\n"
    "messages are in force_depth.csv.active and session.bag.active.\n"
    "Parameters:\n"
    "  ~output_dir     folder, created when absent; required\n"
    "  ~row_period     s, default 0.005\n"
    "  ~hand           record a haptic bridge, default true\n"
    "  ~injector       record an injector, default true\n"
    "  ~holder         record the holder's pressure line in the bag, default false\n"
    "  ~bag            write session.bag, default true\n"
    "  ~training/...   score the session, write training.yaml and training.png and extend the history:\n"
    "                  operator (name), history (CSV file) and the keys of config/training.yaml; default: no score\n"
    "  ~end_when_done  write the files and end in the operator's phase done, default false\n";

SessionRecorderNode::Parameters SessionRecorderNode::Parameters::read(const Bus& bus) {
  Parameters parameters;
  ConfigReader reader = parameterReader(bus);
  reader.path("output_dir", parameters.output_dir, ConfigReader::kRequired);
  reader.number("row_period", parameters.row_period, Range::positive());
  reader.boolean("hand", parameters.hand);
  reader.boolean("injector", parameters.injector);
  reader.boolean("holder", parameters.holder);
  reader.boolean("bag", parameters.bag);
  reader.boolean("end_when_done", parameters.end_when_done);
  if (reader.has("training")) {
    ConfigReader training = reader.section("training");
    parameters.training = TrainingConfig::read(training);
  }
  reader.finish();
  return parameters;
}

SessionRecorderNode::SessionRecorderNode(Bus& bus)
    : parameters_(Parameters::read(bus)),
      cycle_(bus, kRecorderRate),
      files_(parameters_.output_dir, SessionTable::kHeader, parameters_.bag),
      table_(std::llround(1e9 * parameters_.row_period), cycle_.bus().isVirtual() ? kMaxDelayInVirtualTime : kMaxDelay,
             [this](const std::string& line) { files_.rows().append(line); }),
      predicted_(cycle_.input<geometry_msgs::WrenchStamped>("cell/predicted_cf", InputPhase::kSampled, 0.05)),
      needle_(cycle_.input<geometry_msgs::PoseStamped>("needle/measured_cp", InputPhase::kSampled, 0.05)),
      measured_(cycle_.input<geometry_msgs::WrenchStamped>("force_sensor/measured_cf", InputPhase::kSampled, 0.05)),
      cell_(cycle_.input<cell_microinjection::CellState>("cell/state", InputPhase::kSampled, kForever)),
      injection_(cycle_.input<cell_microinjection::InjectionStatus>("controller/injection_state", InputPhase::kSampled,
                                                                    kForever)) {
  if (parameters_.injector) {
    injector_ = &cycle_.input<cell_microinjection::InjectorState>("injector/state", InputPhase::kSampled, 0.05);
  }
  if (parameters_.hand) {
    hand_ = &cycle_.input<geometry_msgs::PoseStamped>("haptic/measured_cp", InputPhase::kSampled, kForever);
    clutch_ = &cycle_.input<sensor_msgs::Joy>("haptic/clutch", InputPhase::kSampled, kForever);
    hand_force_ = &cycle_.input<geometry_msgs::WrenchStamped>("haptic/servo_cf", InputPhase::kSampled, 0.05);
    hand_force_->one_sender = false;  // the watchdog sends zero force beside the bridge
    phase_ = &cycle_.input<cell_microinjection::StringStamped>("virtual_hand/phase", InputPhase::kSampled, kForever);
  }
  began_ = localTime(bus);
  if (parameters_.training) training_ = std::make_unique<TrainingLog>(*parameters_.training);
  if (training_) table_.onRow([this](const SessionTable::Row& row) { training_->add(row); });
  using cell_microinjection::CycleStatistics;
  statistics_ = subscribeGuarded<CycleStatistics>(
      bus, "/cycle_statistics", 100,
      [this](const CycleStatistics& message, const std::string&) { nodes_[message.node] = message; });
  fillTable();
  if (files_.bag()) recordBag(*files_.bag());
  cycle_.diagnostics().add("files", [this](auto& status) { files_.report(status); });
  if (!cycle_.bus().isVirtual()) measureMachine();
  bus.onEnd([this] { finish(); });
  cycle_.onStep([this](const Cycle::Tick& tick) { step(tick); });
}

void SessionRecorderNode::measureMachine() {
  latency_ = std::make_unique<LatencyMeter>(cycle_.bus());
  timer_loop_ = std::make_unique<BareTimerLoop>();
  cycle_.diagnostics().add("bare timer loop", [this](auto& status) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "this machine's limit for a loop at 1 kHz");
    CycleDiagnostics::reportIntervals(timer_loop_->intervals(), status);
  });
}

void SessionRecorderNode::fillTable() {
  needle_.onMessage([this](const geometry_msgs::PoseStamped& message, const ros::Time&) {
    const auto pose = validPose(&message);
    if (!pose) return table_.needle.withdraw();
    tip_orientation_ = pose->linear();
    table_.needle.put(stampOf(message), {{pose->translation(), pose->linear().col(2)}});
  });
  predicted_.onMessage([this](const geometry_msgs::WrenchStamped& message, const ros::Time&) {
    putForce(message, validForce(&message, tip_orientation_), table_.predicted);
  });
  measured_.onMessage([this](const geometry_msgs::WrenchStamped& message, const ros::Time&) {
    std::optional<SessionTable::Measured> measured;
    if (const auto force = finiteForce(&message)) measured = {force->z(), force->x()};
    putForce(message, measured, table_.measured);
  });
  cell_.onMessage([this](const cell_microinjection::CellState& message, const ros::Time&) {
    SessionTable::Cell cell{std::nullopt, message.punctured != 0, message.layers_punctured, message.holes.size()};
    const auto& contact_point = message.contact_point;
    if (message.in_contact) cell.contact_point = Eigen::Vector3d(contact_point.x, contact_point.y, contact_point.z);
    table_.cell.put(stampOf(message), cell);
    layers_ = message.layers;
  });
  injection_.onMessage([this](const cell_microinjection::InjectionStatus& message, const ros::Time&) {
    table_.injection.put(stampOf(message), {{message.state, static_cast<int>(message.punctures)}});
  });
  if (injector_) {
    injector_->onMessage([this](const cell_microinjection::InjectorState& message, const ros::Time&) {
      table_.volume.put(stampOf(message), message.volume);
    });
  }
  if (!parameters_.hand) return;
  hand_force_->onMessage([this](const geometry_msgs::WrenchStamped& message, const ros::Time&) {
    std::optional<double> size;
    if (const auto force = finiteForce(&message)) size = force->norm();
    putForce(message, size, table_.hand_force);
  });
  phase_->onMessage([this](const cell_microinjection::StringStamped& message, const ros::Time&) {
    table_.phase.put(stampOf(message), message.string);
  });
}

void SessionRecorderNode::recordBag(SessionBag& bag) {
  bag.record(needle_);
  bag.record(predicted_);
  bag.record(measured_);
  bag.record(cell_);
  bag.record(injection_);
  if (injector_) bag.record(*injector_);
  if (parameters_.holder) {
    bag.record<cell_microinjection::HolderState>(cycle_.bus(), "/holder/state");
    bag.record<cell_microinjection::CellHold>(cycle_.bus(), "/cell/hold");
  }
  if (parameters_.hand) {
    bag.record(*hand_);
    bag.record(*clutch_);
    bag.record(*hand_force_);
    bag.record(*phase_);
  }
  bag.record<tf2_msgs::TFMessage>(cycle_.bus(), "/tf");
  bag.record<tf2_msgs::TFMessage>(cycle_.bus(), "/tf_static");
  bag.record<diagnostic_msgs::DiagnosticArray>(cycle_.bus(), "/diagnostics");
  bag.record<cell_microinjection::CycleStatistics>(cycle_.bus(), "/cycle_statistics");
  for (const char* topic : {"/controller/loop_state", "/haptic/loop_state", "/link/rig/loop_state"}) {
    bag.record<cell_microinjection::LoopState>(cycle_.bus(), topic);
  }
  bag.record<cell_microinjection::OperatingState>(cycle_.bus(), "/controller/operating_state");
}

void SessionRecorderNode::finish() {
  table_.finish();
  std::vector<std::string> errors = files_.finish();
  const auto attempt = [&errors](const auto& write) {
    try {
      write();
    } catch (const std::exception& error) {
      errors.push_back(error.what());
    }
  };
  attempt([this] { writeFileAtomically(parameters_.output_dir + "/summary.yaml", summary()); });
  if (training_) attempt([&] { score(errors); });
  if (errors.empty()) return;
  // After an interrupt, ROS's own log has ended.
  for (const std::string& error : errors) std::cerr << error << std::endl;
  throw std::runtime_error("the session's files are incomplete: " + errors.front() +
                           (errors.size() > 1 ? "; and " + std::to_string(errors.size() - 1) + " more" : ""));
}

void SessionRecorderNode::score(std::vector<std::string>& errors) const {
  const TrainingConfig& config = training_->config();
  const TrainingLog::Result result = training_->finish(parameters_.output_dir, began_);
  std::cout << result.text << std::endl;
  errors.insert(errors.end(), result.errors.begin(), result.errors.end());
  if (!result.in_history) return;
  const std::string picture = parameters_.output_dir + "/training.png";
  const std::string plot = std::filesystem::path(thisProgram()).parent_path() / "plot_training.py";
  const auto tellNoPicture = [&](const std::string& reason) {
    std::cerr << "no picture: " << reason << "; the history is " << config.history << std::endl;
  };
  try {
    runWorkers({{plot, config.history, picture, "--trainee", config.trainee}}, 1, [&](std::size_t, int status) {
      if (status == 0) std::cout << "compared with earlier sessions in " << picture << std::endl;
      if (status != 0) tellNoPicture(plot + " has failed");
    });
  } catch (const std::exception& error) {  // the session's own files are complete without it
    tellNoPicture(error.what());
  }
}

void SessionRecorderNode::step(const Cycle::Tick& tick) {
  withdrawInvalid();
  table_.advance(stampOf(tick.now));
  files_.step(tick.now);
  if (table_.done() && parameters_.end_when_done) cycle_.bus().stop();
}

/// An input may become invalid without a message: by a clock that was set back.
void SessionRecorderNode::withdrawInvalid() {
  if (!needle_.valid()) table_.needle.withdraw();
  if (!predicted_.valid()) table_.predicted.withdraw();
  if (!measured_.valid()) table_.measured.withdraw();
  if (hand_force_ && !hand_force_->valid()) table_.hand_force.withdraw();
}

std::string SessionRecorderNode::summary() const {
  std::ostringstream out;
  const char* const clock = cycle_.bus().isVirtual() ? "virtual" : "wall";
  out << "clock: " << clock << '\n';
  out << "duration_s: " << table_.duration() << '\n';
  out << "layers: [";
  for (std::size_t i = 0; i < layers_.size(); ++i) out << (i > 0 ? ", " : "") << layers_[i];
  out << "]\nnodes:\n";
  for (const auto& [name, node] : nodes_) {
    if (node.topic.empty()) continue;
    out << "  - {node: " << name << ", topic: " << node.topic << ", count: " << node.steps
        << ", rate_hz: " << node.mean_rate << ", interval_median_ms: " << 1e3 * node.median_interval
        << ", interval_p99_ms: " << 1e3 * node.p99_interval << "}\n";
  }
  if (latency_) writeIntervals(out, "hand_to_force_latency", latency_->latencies());
  if (timer_loop_) writeIntervals(out, "bare_timer_loop", timer_loop_->intervals());
  return out.str();
}

}  // namespace microinjection
