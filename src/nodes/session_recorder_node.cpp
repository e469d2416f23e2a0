#include "nodes/session_recorder_node.h"

#include <tf2_msgs/TFMessage.h>

#include <cstdlib>
#include <limits>

#include "base/atomic_file.h"
#include "cell_microinjection/OperatingState.h"
#include "nodes/conversions.h"
#include "nodes/node_parameters.h"

namespace microinjection {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

std::string value(const diagnostic_msgs::DiagnosticStatus& status, const std::string& key) {
  for (const auto& pair : status.values) {
    if (pair.key == key) return pair.value;
  }
  return "";
}

void writeIntervals(std::ostream& out, const std::string& name, const IntervalHistogram& intervals) {
  out << name << ": {count: " << intervals.count() << ", median_ms: " << 1e3 * intervals.quantile(0.5)
      << ", p99_ms: " << 1e3 * intervals.quantile(0.99) << ", max_ms: " << 1e3 * intervals.largest() << "}\n";
}

}  // namespace

const char* const SessionRecorderNode::kHelp =
    "session_recorder: writes force_depth.csv, summary.yaml and session.bag of a session when it ends.\n"
    "Parameters: ~output_dir (required), ~row_period (s), ~hand (record a hand), ~bag,\n~end_when_done.\n";

SessionRecorderNode::Parameters SessionRecorderNode::Parameters::read(const ros::NodeHandle& private_node) {
  Parameters parameters;
  ConfigReader reader = parameterReader(private_node);
  reader.text("output_dir", parameters.output_dir, ConfigReader::kRequired);
  reader.number("row_period", parameters.row_period, Range::positive());
  reader.boolean("hand", parameters.hand);
  reader.boolean("bag", parameters.bag);
  reader.boolean("end_when_done", parameters.end_when_done);
  reader.finish();
  return parameters;
}

SessionRecorderNode::SessionRecorderNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : parameters_(Parameters::read(private_node)),
      cycle_(node, 1000),
      predicted_(cycle_.input<geometry_msgs::WrenchStamped>("cell/predicted_cf", Phase::kSameTick, 0.05)),
      needle_(cycle_.input<geometry_msgs::PoseStamped>("needle/measured_cp", Phase::kTickBefore, 0.05)),
      measured_(cycle_.input<geometry_msgs::WrenchStamped>("force_sensor/measured_cf", Phase::kTickBefore, 0.05)),
      cell_(cycle_.input<cell_microinjection::CellState>("cell/state", Phase::kTickBefore, kForever)) {
  if (parameters_.hand) {
    hand_ = &cycle_.input<geometry_msgs::PoseStamped>("haptic/measured_cp", Phase::kTickBefore, kForever);
    clutch_ = &cycle_.input<sensor_msgs::Joy>("haptic/clutch", Phase::kTickBefore, kForever);
    hand_force_ = &cycle_.input<geometry_msgs::WrenchStamped>("haptic/servo_cf", Phase::kTickBefore, 0.05);
    phase_ = &cycle_.input<cell_microinjection::StringStamped>("operator/phase", Phase::kTickBefore, kForever);
  }
  diagnostics_ = cycle_.node().subscribe("/diagnostics", 100, &SessionRecorderNode::onDiagnostics, this);
  rows_.precision(9);
  rows_ << "time_s,phase,depth_m,predicted_axial_N,measured_axial_N,measured_lateral_N,hand_force_N,in_contact,"
           "punctured\n";
  if (parameters_.bag) recordBag();
  if (cycle_.lockstep()) return;
  latency_ = std::make_unique<LatencyMeter>(cycle_.node());
  timer_loop_ = std::make_unique<BareTimerLoop>();
}

void SessionRecorderNode::recordBag() {
  bag_ = std::make_unique<SessionBag>(parameters_.output_dir + "/session.bag");
  bag_->follow(needle_);
  bag_->follow(predicted_);
  bag_->follow(measured_);
  bag_->follow(cell_);
  if (parameters_.hand) {
    bag_->follow(*hand_);
    bag_->follow(*clutch_);
    bag_->follow(*hand_force_);
    bag_->follow(*phase_);
  }
  bag_->follow<tf2_msgs::TFMessage>(cycle_.node(), "/tf");
  bag_->follow<tf2_msgs::TFMessage>(cycle_.node(), "/tf_static");
  bag_->follow<diagnostic_msgs::DiagnosticArray>(cycle_.node(), "/diagnostics");
  bag_->follow<cell_microinjection::OperatingState>(cycle_.node(), "/controller/operating_state");
}

void SessionRecorderNode::run() {
  cycle_.run([this](const Cycle::Tick& tick) { step(tick); });
  if (bag_) bag_->close();
  writeFileAtomically(parameters_.output_dir + "/force_depth.csv", rows_.str());
  writeFileAtomically(parameters_.output_dir + "/summary.yaml", summary());
}

void SessionRecorderNode::step(const Cycle::Tick& tick) {
  if (began_.isZero()) began_ = tick.now;
  if (const auto* phase = phase_ ? phase_->get(tick.now) : nullptr; phase && phase->string == "done") {
    if (parameters_.end_when_done) cycle_.stop();
    return;  // the same rows however long the nodes live on
  }
  const auto needle = trustedPose(needle_.get(tick.now));
  const auto force = trustedForce(predicted_.get(tick.now), Eigen::Matrix3d::Identity());
  if (needle && force) followContact(needle->translation(), !force->isZero());
  if ((tick.now - row_written_).toSec() >= parameters_.row_period - 1e-9) writeRow(tick.now);
}

void SessionRecorderNode::followContact(const Eigen::Vector3d& tip, bool in_contact) {
  if (in_contact && !in_contact_) {
    touched_at_ = tip_before_;
    touched_ = true;
  }
  in_contact_ = in_contact;
  tip_before_ = tip;
}

void SessionRecorderNode::writeRow(const ros::Time& now) {
  const auto needle = trustedPose(needle_.get(now));
  const auto predicted = needle ? trustedForce(predicted_.get(now), needle->linear()) : std::nullopt;
  const auto* measured = measured_.get(now);
  const auto hand = finiteForce(hand_force_ ? hand_force_->get(now) : nullptr);
  const auto* phase = phase_ ? phase_->get(now) : nullptr;
  const auto* cell = cell_.get(now);
  rows_ << (now - began_).toSec() << ',' << (phase ? phase->string : "") << ',';
  if (needle && touched_) rows_ << (touched_at_ - needle->translation()).dot(needle->linear().col(2));
  rows_ << ',';
  if (predicted) rows_ << predicted->dot(needle->linear().col(2));
  rows_ << ',';
  if (measured) rows_ << measured->wrench.force.z << ',' << measured->wrench.force.x << ',';
  if (!measured) rows_ << ",,";
  if (hand) rows_ << hand->norm();
  rows_ << ',' << in_contact_ << ',' << (cell && cell->punctured) << '\n';
  row_written_ = now;
}

void SessionRecorderNode::onDiagnostics(const diagnostic_msgs::DiagnosticArrayConstPtr& message) {
  for (const auto& status : message->status) {
    const std::size_t colon = status.name.find(": cycle");
    if (colon == std::string::npos) continue;
    NodeFigures& figures = figures_[status.name.substr(0, colon)];
    for (const auto& pair : status.values) {
      if (pair.key.rfind("sent on ", 0) == 0 && figures.topic.empty()) figures.topic = "/" + pair.key.substr(8);
    }
    figures.count = value(status, "steps since the start");
    figures.rate = value(status, "mean rate since the start (Hz)");
    figures.median = value(status, "median interval since the start (s of wall time)");
    figures.p99 = value(status, "99 % interval since the start (s of wall time)");
  }
}

std::string SessionRecorderNode::summary() const {
  std::ostringstream out;
  out << "clock: " << (cycle_.lockstep() ? "lockstep" : "wall") << '\n';
  out << "duration_s: " << (row_written_ - began_).toSec() << '\n';
  out << "nodes:\n";
  for (const auto& [node, figures] : figures_) {
    if (figures.topic.empty()) continue;
    out << "  - {node: " << node << ", topic: " << figures.topic << ", count: " << figures.count
        << ", rate_hz: " << figures.rate << ", interval_median_ms: " << 1e3 * std::atof(figures.median.c_str())
        << ", interval_p99_ms: " << 1e3 * std::atof(figures.p99.c_str()) << "}\n";
  }
  if (latency_) writeIntervals(out, "hand_to_force_latency", latency_->latencies());
  if (timer_loop_) writeIntervals(out, "bare_timer_loop", timer_loop_->stop());
  return out.str();
}

}  // namespace microinjection
