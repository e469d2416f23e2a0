#include "nodes/cell_estimator_node.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/cpu_time.h"
#include "base/errors.h"
#include "cell/model/cell_parameters.h"
#include "cell/model/placed_cell.h"
#include "nodes/cell/estimate_messages.h"
#include "nodes/display/cell_state_reader.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {
namespace {

constexpr double kSameSize = 1e-6;  ///< relative, of a parameter that has not changed
constexpr double kDetection = 0.1;  ///< s, in which a puncture is detected: its readings are no cell's
constexpr double kApart = 0.3e-6;   ///< m, of the needle between the times of position and force

/// Moduli are what is estimated; the others are where the prior is.
bool isModulus(const std::string& name) { return name == "young_modulus" || name == "core_modulus"; }

}  // namespace

CellEstimatorParameters CellEstimatorParameters::read(const Bus& bus) {
  CellEstimatorParameters parameters;
  ConfigReader reader = parameterReader(bus);
  reader.path("scene", parameters.scene, ConfigReader::kRequired);
  reader.path("families", parameters.families, ConfigReader::kRequired);
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  reader.number("update_period", parameters.update_period, Range::closed(0.005, 1));
  reader.number("needle_timeout", parameters.needle_timeout, Range::positive());
  reader.number("force_timeout", parameters.force_timeout, Range::positive());
  reader.number("controller_timeout", parameters.controller_timeout, Range::positive());
  reader.number("largest_tilt", parameters.largest_tilt, Range::closed(0, 0.2));
  reader.number("largest_speed", parameters.largest_speed, Range::positive());
  reader.number("largest_force", parameters.largest_force, Range::positive());
  reader.number("largest_sideways", parameters.largest_sideways, Range::positive());
  reader.number("clear_distance", parameters.clear_distance, Range::positive());
  reader.boolean("serve", parameters.serve);
  parameters.served.read(reader);
  reader.number("puncture_deviation", parameters.puncture_deviation, Range::closed(0, 2));
  ConfigReader image = reader.section("image");
  image.boolean("use", parameters.images);
  parameters.image.read(image);
  ConfigReader estimator = reader.section("estimator");
  parameters.estimator.read(estimator);
  reader.finish();
  return parameters;
}

const char* const CellEstimatorNode::kHelp =
    "cell_estimator: the cell estimator. Finds modulus and height of the cell under the needle and has cell_simulator\n"
    "serve them.\n"
    "In: /needle/measured_cp, /force_sensor/measured_cf, /controller/injection_state, /cell/state, /vision/state.\n"
    "Out: /cell/estimate, /cell/set_parameters, /cell/puncture_score.\n";

CellEstimatorNode::CellEstimatorNode(Bus& bus)
    : parameters_(CellEstimatorParameters::read(bus)),
      cycle_(bus, parameters_.rate),
      needle_(cycle_.input<geometry_msgs::PoseStamped>("needle/measured_cp", InputPhase::kSampled,
                                                       parameters_.needle_timeout)),
      force_(cycle_.input<geometry_msgs::WrenchStamped>("force_sensor/measured_cf", InputPhase::kWakes,
                                                        parameters_.force_timeout)),
      controller_(cycle_.input<cell_microinjection::InjectionStatus>("controller/injection_state", InputPhase::kSampled,
                                                                     parameters_.controller_timeout)),
      estimate_(cycle_.output<cell_microinjection::CellEstimate>("cell/estimate")),
      change_(cycle_.output<cell_microinjection::CellParameters>("cell/set_parameters")),
      score_(cycle_.output<cell_microinjection::PunctureScore>("cell/puncture_score", true)),
      served_(parameters_.served, 1) {
  const Scene scene = loadScene(parameters_.scene);
  CellFollowerConfig served = parameters_.served;
  served.largest_height = std::min(served.largest_height, PlacedCell::kHighest * scene.radius());
  served_ = CellFollower(served, scene.cell.material().young_modulus);
  families_ = loadFamilies(parameters_.families);
  std::string reason;
  auto member = findFamilyCell(parameters_.families, scene, reason);
  if (!member) {
    throw ConfigError(parameters_.scene + ": the estimator needs a cell of a family, and this is of none" +
                      (reason.empty() ? "" : ": " + reason));
  }
  if (parameters_.images) dimples_ = std::make_unique<DimpleReader>(bus, parameters_.image);
  take(scene, std::move(*member));
  cell_ = subscribeGuarded(bus, "cell/state", 1, &CellEstimatorNode::onCell, this);
  force_.onMessage([this](const geometry_msgs::WrenchStamped& message, const ros::Time&) { followForce(message); });
  cycle_.diagnostics().add("cell under the needle", [this](auto& status) { report(status); });
  cycle_.onStep([this](const Cycle::Tick& tick) { step(tick); });
}

/// Everything of another cell; the present one stays when that fails.
void CellEstimatorNode::take(const Scene& scene, FamilyCell member) {
  auto rivals = std::make_shared<const std::vector<RivalCell>>(rivalCells(families_, scene));
  auto estimator = std::make_unique<CellEstimator>(scene, member.data, parameters_.estimator, std::move(rivals));
  auto predictor = std::make_unique<PuncturePredictor>(scene, member.data, parameters_.puncture_deviation);
  scene_ = scene;
  member_ = std::move(member);
  estimator_ = std::move(estimator);
  predictor_ = std::move(predictor);
  indentation_ = {};
  if (dimples_) dimples_->startCell(scene.radius());
}

/// Another cell, measured in the image, say: what was learned is of the one before.
void CellEstimatorNode::onCell(const cell_microinjection::CellState& message) {
  served_.setServed({cellParameter(message, "young_modulus").value_or(served_.served().modulus),
                     cellParameter(message, PlacedCell::kName).value_or(served_.served().height)});
  std::vector<CellParameter> changed;
  for (const CellParameter& known : cellParameters(scene_)) {
    if (isModulus(known.name)) continue;
    const auto value = cellParameter(message, known.name);
    if (value && std::abs(*value - known.value) > kSameSize * std::abs(known.value))
      changed.push_back({known.name, *value});
  }
  if (changed.empty()) {
    foreign_.clear();
    return;
  }
  if (!foreign_.empty() && message.parameter_values == foreign_values_) return;  // refused before
  foreign_values_ = message.parameter_values;
  const Scene next = withParameters(scene_, changed);
  auto member = makeFamilyCell(member_.family, next, foreign_);
  if (!member) {
    if (foreign_.empty()) foreign_ = "it is of another form";
    return;
  }
  foreign_.clear();
  take(next, std::move(*member));
  other_cell_ = true;
  ROS_INFO_STREAM("another cell is served; nothing is known of it yet: " << member_.description);
}

std::string CellEstimatorNode::interruption(const ros::Time& now) const {
  if (!foreign_.empty()) return "the family does not contain the served cell: " + foreign_;
  if (!controller_.fresh(now)) return "no state of the injection_controller: nobody knows of a puncture";
  if (!indentation_.clear()) return "the needle has not been clear of this cell";
  return indentation_.punctured() ? "the cell is punctured" : "";
}

void CellEstimatorNode::followIndentation(const Eigen::Vector3d& tip, const ros::Time& now) {
  const auto* status = controller_.get(now);
  const double surface = scene_.radius() + estimator_->estimate().contact;
  switch (indentation_.follow(tip, {surface, scene_.radius() + parameters_.clear_distance},
                              status ? std::optional(status->punctures) : std::nullopt)) {
    case IndentationCourse::Event::kEnded:
      estimator_->beginNext();
      if (dimples_) dimples_->startCell(scene_.radius());
      break;
    case IndentationCourse::Event::kPunctured:
      punctured_at_ = now;
      is_scored_ = false;
      estimator_->forgetSince(now.toSec() - kDetection);
      break;
    case IndentationCourse::Event::kNone:
      break;
  }
}

/// Of each reading up to the puncture, which may come later than the controller's word of it.
void CellEstimatorNode::followForce(const geometry_msgs::WrenchStamped& message) {
  if (indentation_.punctured() && message.header.stamp > punctured_at_) return;
  const auto force = validForce(&message, orientation_);
  if (force) indentation_.addForce(orientation_.col(2).dot(*force) - estimator_->estimate().offset);
}

std::string CellEstimatorNode::learn(const ros::Time& now) {
  const auto needle = validPose(needle_.get(now));
  if (!needle) return "no valid needle pose";
  orientation_ = needle->linear();
  const Eigen::Vector3d axis = orientation_.col(2), tip = needle->translation();
  followIndentation(tip, now);
  followSpeed(tip, now);
  const std::string interrupted = interruption(now);
  if (dimples_) dimples_->follow(needle_.get(now)->header.stamp, tip, interrupted.empty());
  if (!interrupted.empty()) return interrupted;
  if (std::acos(std::clamp(axis.z(), -1.0, 1.0)) > parameters_.largest_tilt) return "the needle is tilted";
  if (indentation_.sideways(tip) > parameters_.largest_sideways) return "the needle has moved sideways in the cell";
  const auto* message = force_.get(now);
  const auto force = validForce(message, orientation_);
  if (!force) return "no valid force of the sensor: the modulus cannot be known without it";
  const double along = axis.dot(*force);
  if (speed_ > parameters_.largest_speed) return "the needle is fast: the sensor's delay would count";
  if (message->header.stamp == last_force_) return held_;  // heard before
  last_force_ = message->header.stamp;
  if (std::abs(along) > parameters_.largest_force) return "the force sensor is saturated";
  const double apart = std::abs(secondsBetween(needle_.get(now)->header.stamp, message->header.stamp));
  if (speed_ * apart > kApart) return "position and force are of different times for a needle of this speed";
  return estimator_->add(message->header.stamp.toSec(), tip, along);
}

/// Over a while: the noise of two neighbouring positions would be a speed.
void CellEstimatorNode::followSpeed(const Eigen::Vector3d& tip, const ros::Time& now) {
  constexpr double kWhile = 0.01;  // s
  if (!isDue(marked_, now, kWhile)) return;
  const double passed = secondsBetween(marked_, now);
  speed_ = marked_.isZero() || passed <= 0 ? 0 : (tip - mark_).norm() / passed;
  mark_ = tip;
  marked_ = now;
}

void CellEstimatorNode::step(const Cycle::Tick& tick) {
  if (!last_step_.isZero() && tick.now < last_step_) {  // time was set back: the samples are ahead of it
    estimator_->beginNext();
    indentation_ = {};
  }
  last_step_ = tick.now;
  held_ = learn(tick.now);
  if (!is_scored_ && indentation_.punctured() && secondsBetween(punctured_at_, tick.now) >= kDetection) score(tick.now);
  if (!isDue(updated_, tick.now, parameters_.update_period)) return;
  updated_ = tick.now;
  const double start = threadCpuTime();
  if (dimples_ && !indentation_.punctured()) estimator_->seeContact(dimples_->height());
  if (held_.empty() && estimator_->update().samples > 0) indentation_.learn(estimator_->estimate().depth);
  if (!indentation_.punctured()) predict();
  const double taken = cycle_.bus().isVirtual() ? 0 : threadCpuTime() - start;  // differs in each run
  serve(tick.now);
  publish(tick.now, taken);
}

/// What was found; the prior when the force contradicts the model. While no modulus is known, nothing but
/// the place that images show, and another cell's place. A punctured cell stays where it is: the needle is in its hole.
void CellEstimatorNode::serve(const ros::Time& now) {
  const CellEstimate& found = estimator_->estimate();
  const bool known = found.verdict != EstimateVerdict::kPrior;
  const bool seen = dimples_ && dimples_->height();
  if (!parameters_.serve || indentation_.punctured() || !(known || seen || other_cell_)) return;
  other_cell_ = !known && !seen && served_.served().height != 0;
  const CellFollower::Properties other{served_.served().modulus, found.contact}, learned{found.modulus, found.contact};
  const auto asked = served_.ask(known ? learned : other, now.toSec());
  if (!asked) return;
  cell_microinjection::CellParameters parameters;
  parameters.header.stamp = now;
  const auto add = [&](const std::string& name, double value) {
    parameters.name.push_back(name);
    parameters.value.push_back(value);
  };
  const double factor = asked->modulus / scene_.cell.material().young_modulus;
  for (const CellParameter& own : cellParameters(scene_)) {
    if (isModulus(own.name)) add(own.name, factor * own.value);
  }
  add(PlacedCell::kName, asked->height);
  change_.publish(parameters);
}

void CellEstimatorNode::predict() {
  const CellEstimate& found = estimator_->estimate();
  expected_ = predictor_->predict(found.modulus, std::sqrt(found.covariance(0, 0)), indentation_.depth());
  if (expected_) indentation_.expect(*expected_);
}

void CellEstimatorNode::score(const ros::Time& now) {
  is_scored_ = true;
  cell_microinjection::PunctureScore message;
  message.header.stamp = now;
  message.depth = indentation_.depth();
  message.force = indentation_.peak();
  message.predicted = toMessage(indentation_.expectedAtHalf());
  const auto& expected = message.predicted;
  ROS_INFO(
      "punctured at %.3g um and %.3g uN; expected at half the depth: %.3g um (%.3g to %.3g), %.3g uN (%.3g to %.3g)",
      1e6 * message.depth, 1e6 * message.force, 1e6 * expected.depth, 1e6 * expected.depth_low,
      1e6 * expected.depth_high, 1e6 * expected.force, 1e6 * expected.force_low, 1e6 * expected.force_high);
  score_.publish(message);
}

void CellEstimatorNode::publish(const ros::Time& now, double update_time) {
  cell_microinjection::CellEstimate message = toMessage(estimator_->estimate());
  message.header.stamp = now;
  message.held = held_;
  if (!indentation_.punctured()) message.puncture = toMessage(expected_);
  message.served_modulus = served_.served().modulus;
  message.served_height = served_.served().height;
  message.update_time = update_time;
  estimate_.publish(message);
}

void CellEstimatorNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const CellEstimate& found = estimator_->estimate();
  const bool bad = found.verdict == EstimateVerdict::kInconsistent || served_.refused();
  std::string text = toText(found.verdict);
  if (!found.reason.empty()) text += ": " + found.reason;
  if (!held_.empty()) text += "; not learning: " + held_;
  if (served_.refused()) text += "; cell_simulator does not serve what it was asked to";
  status.summary(bad ? diagnostic_msgs::DiagnosticStatus::WARN : diagnostic_msgs::DiagnosticStatus::OK, text);
  status.add("modulus (Pa)", found.modulus);
  status.add("served modulus (Pa)", served_.served().modulus);
  status.add("served height (m)", served_.served().height);
  status.add("misfit", found.misfit);
  if (!expected_) return;
  status.add("expected puncture: depth (m)", expected_->depth);
  status.add("expected puncture: force (N)", expected_->force);
}

}  // namespace microinjection
