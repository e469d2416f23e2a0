#include "nodes/cell_estimator_node.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/cpu_time.h"
#include "base/errors.h"
#include "cell/model/cell_parameters.h"
#include "nodes/cell/cell_state_reader.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/node_parameters.h"
#include "nodes/runtime/run_node.h"

namespace microinjection {
namespace {

constexpr double kSameSize = 1e-6;  ///< relative, of a parameter that has not changed

/// Moduli are what is estimated; the others are where the prior is.
bool isModulus(const std::string& name) { return name == "young_modulus" || name == "core_modulus"; }

}  // namespace

const char* const CellEstimatorNode::kHelp =
    "cell_estimator: the online twin. Finds the modulus of the cell under the needle and has cell_simulator serve it.\n"
    "In: /needle/measured_cp, /force_sensor/measured_cf, /controller/injection_state, /cell/state.\n"
    "Out: /cell/estimate, /cell/set_parameters.\n";

CellEstimatorNode::Parameters CellEstimatorNode::Parameters::read(const ros::NodeHandle& private_node) {
  Parameters parameters;
  ConfigReader reader = parameterReader(private_node);
  reader.text("scene", parameters.scene, ConfigReader::kRequired);
  reader.text("families", parameters.families, ConfigReader::kRequired);
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  reader.number("update_period", parameters.update_period, Range::closed(0.005, 1));
  reader.number("needle_timeout", parameters.needle_timeout, Range::positive());
  reader.number("force_timeout", parameters.force_timeout, Range::positive());
  reader.number("controller_timeout", parameters.controller_timeout, Range::positive());
  reader.number("largest_tilt", parameters.largest_tilt, Range::closed(0, 0.2));
  reader.number("largest_force", parameters.largest_force, Range::positive());
  reader.number("clear_distance", parameters.clear_distance, Range::positive());
  reader.boolean("serve", parameters.serve);
  reader.number("serve_period", parameters.serve_period, Range::closed(0.02, 10));
  reader.number("least_change", parameters.least_change, Range::closed(1e-4, 0.5));
  reader.number("largest_change", parameters.largest_change, Range::closed(0.01, 2));
  ConfigReader estimator = reader.section("estimator");
  parameters.estimator.read(estimator);
  reader.finish();
  return parameters;
}

CellEstimatorNode::CellEstimatorNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : parameters_(Parameters::read(private_node)),
      scene_(loadScene(parameters_.scene)),
      cycle_(node, parameters_.rate),
      needle_(cycle_.input<geometry_msgs::PoseStamped>("needle/measured_cp", InputPhase::kPreviousTick,
                                                       parameters_.needle_timeout)),
      force_(cycle_.input<geometry_msgs::WrenchStamped>("force_sensor/measured_cf", InputPhase::kTrigger,
                                                        parameters_.force_timeout)),
      controller_(cycle_.input<cell_microinjection::InjectionStatus>(
          "controller/injection_state", InputPhase::kPreviousTick, parameters_.controller_timeout)),
      estimate_(cycle_.output<cell_microinjection::CellEstimate>("cell/estimate")),
      change_(cycle_.output<cell_microinjection::CellParameters>("cell/set_parameters")) {
  makeEstimator();
  served_ = scene_.cell.material().young_modulus;
  cell_ = subscribeGuarded<cell_microinjection::CellState>(
      cycle_.node(), "cell/state", 1,
      [this](const cell_microinjection::CellState& message, const std::string&) { onCell(message); });
  cycle_.diagnostics().add("cell under the needle", [this](auto& status) { report(status); });
}

void CellEstimatorNode::makeEstimator() {
  std::string reason;
  const auto found = findFamilyCell(parameters_.families, scene_, reason);
  if (!found) {
    throw ConfigError(parameters_.scene + ": the twin needs a cell of a family, and this is of none" +
                      (reason.empty() ? "" : ": " + reason));
  }
  member_ = *found;
  estimator_ = std::make_unique<CellEstimator>(scene_, member_.data, parameters_.estimator);
}

/// Another cell, measured in the image, say: what was learned is of the one before.
void CellEstimatorNode::onCell(const cell_microinjection::CellState& message) {
  std::vector<CellParameter> changed;
  for (const CellParameter& known : cellParameters(scene_)) {
    if (isModulus(known.name)) continue;
    const auto value = cellParameter(message, known.name);
    if (value && std::abs(*value - known.value) > kSameSize * std::abs(known.value))
      changed.push_back({known.name, *value});
  }
  if (changed.empty()) return;
  scene_ = withParameters(scene_, changed);
  makeEstimator();
  touched_ = finished_ = false;
  ROS_INFO_STREAM("another cell is served; nothing is known of it yet: " << member_.description);
}

void CellEstimatorNode::run() {
  cycle_.run([this](const Cycle::Tick& tick) { step(tick); });
}

std::string CellEstimatorNode::interruption(const ros::Time& now) const {
  if (!controller_.fresh(now)) return "no state of the injection_controller: nobody knows of a puncture";
  return finished_ ? "the cell is punctured" : "";
}

std::string CellEstimatorNode::learn(const ros::Time& now) {
  const auto needle = validPose(needle_.get(now));
  if (!needle) return "no valid needle pose";
  const Eigen::Vector3d axis = needle->linear().col(2), tip = needle->translation();
  if (tip.norm() > scene_.radius() + parameters_.clear_distance && std::exchange(touched_, false)) {
    estimator_->reset();
    finished_ = false;
  }
  if (const auto* status = controller_.get(now)) {
    if (!touched_) punctures_before_ = status->punctures;
    finished_ = finished_ || status->punctures > punctures_before_;
  }
  const std::string interrupted = interruption(now);
  if (!interrupted.empty()) return interrupted;
  if (std::acos(std::clamp(axis.z(), -1.0, 1.0)) > parameters_.largest_tilt) return "the needle is tilted";
  const auto* message = force_.get(now);
  const auto force = validForce(message, needle->linear());
  if (!force) return "no valid force of the sensor";
  if (message->header.stamp == last_force_) return held_;  // heard before
  last_force_ = message->header.stamp;
  const double along = axis.dot(*force);
  if (std::abs(along) > parameters_.largest_force) return "the force sensor is saturated";
  estimator_->add(message->header.stamp.toSec(), tip, along);
  return "";
}

void CellEstimatorNode::step(const Cycle::Tick& tick) {
  held_ = learn(tick.now);
  if (secondsBetween(updated_, tick.now) < parameters_.update_period && !updated_.isZero()) return;
  updated_ = tick.now;
  const double start = threadCpuTime();
  if (held_.empty()) touched_ = estimator_->update().samples > 0 || touched_;
  const double taken = threadCpuTime() - start;
  serve(tick.now);
  publish(tick.now, taken);
}

/// In small steps towards what was found: towards the prior when the force contradicts the model, and
/// nowhere while nothing is known.
void CellEstimatorNode::serve(const ros::Time& now) {
  const CellEstimate& found = estimator_->estimate();
  if (!parameters_.serve || found.verdict == EstimateVerdict::kPrior) return;
  if (!served_at_.isZero() && secondsBetween(served_at_, now) < parameters_.serve_period) return;
  const double change = std::log(found.modulus / served_);
  if (std::abs(change) < parameters_.least_change) return;
  served_at_ = now;
  served_ *= std::exp(std::clamp(change, -parameters_.largest_change, parameters_.largest_change));
  cell_microinjection::CellParameters parameters;
  parameters.header.stamp = now;
  const double factor = served_ / scene_.cell.material().young_modulus;
  for (const CellParameter& known : cellParameters(scene_)) {
    if (!isModulus(known.name)) continue;
    parameters.name.push_back(known.name);
    parameters.value.push_back(factor * known.value);
  }
  change_.publish(parameters);
}

void CellEstimatorNode::publish(const ros::Time& now, double update_time) {
  const CellEstimate& found = estimator_->estimate();
  cell_microinjection::CellEstimate message;
  message.header.stamp = now;
  message.verdict = toText(found.verdict);
  message.reason = found.reason;
  message.held = held_;
  message.modulus = found.modulus;
  message.modulus_low = found.modulus_low;
  message.modulus_high = found.modulus_high;
  message.contact = found.contact;
  message.offset = found.offset;
  std::copy_n(found.covariance.data(), 9, message.covariance.begin());  // symmetric
  message.depth = found.depth;
  message.misfit = found.misfit;
  message.samples = static_cast<std::uint32_t>(found.samples);
  message.served_modulus = served_;
  message.update_time = update_time;
  estimate_.publish(message);
}

void CellEstimatorNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const CellEstimate& found = estimator_->estimate();
  const bool bad = found.verdict == EstimateVerdict::kInconsistent;
  std::string text = toText(found.verdict);
  if (!found.reason.empty()) text += ": " + found.reason;
  if (!held_.empty()) text += "; not learning: " + held_;
  status.summary(bad ? diagnostic_msgs::DiagnosticStatus::WARN : diagnostic_msgs::DiagnosticStatus::OK, text);
  status.add("modulus (Pa)", found.modulus);
  status.add("served modulus (Pa)", served_);
  status.add("misfit", found.misfit);
}

}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::CellEstimatorNode>(argc, argv, "cell_estimator");
}
