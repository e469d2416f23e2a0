#include "nodes/calibration_node.h"

#include <cell_microinjection/StringStamped.h>

#include <ctime>
#include <filesystem>

#include "base/errors.h"
#include "nodes/imaging/calibration_messages.h"
#include "nodes/imaging/image_input.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/node_parameters.h"
#include "vision/calibration/calibration_file.h"

namespace microinjection {
namespace {

constexpr double kCalibrationPeriod = 0.02;  // s, of a step
constexpr double kFar = 1;                   // m, a border that the micromanipulator's own limits come before

}  // namespace

const char* const CalibrationNode::kHelp =
    "calibration: calibrates the camera against the manipulator, and watches the calibration.\n"
    "In: vision/state, /needle/measured_cp, /needle/operating_state, /controller/operating_state.\n"
    "Out: /needle/servo_cp; action calibration/calibrate, services calibration/rezero and calibration/undo.\n";

CalibrationNode::Parameters CalibrationNode::Parameters::read(const Bus& bus) {
  Parameters parameters;
  ConfigReader reader = parameterReader(bus);
  reader.path("file", parameters.file);
  reader.number("input_timeout", parameters.input_timeout, Range::positive());
  parameters.calibration = CalibrationConfig::read(reader);
  reader.finish();
  parameters.file = calibrationPath(parameters.file);
  return parameters;
}

CalibrationNode::CalibrationNode(Bus& bus)
    : GoalNode(bus, "calibration/calibrate", "calibration", kCalibrationPeriod),
      parameters_(Parameters::read(bus)),
      watch_(bus, parameters_.input_timeout),
      drift_(parameters_.calibration.drift),
      setpoints_(bus.advertise<geometry_msgs::PoseStamped>("/needle/servo_cp", 1)),
      commands_(subscribeGuarded<cell_microinjection::StringStamped>(
          bus, "/needle/state_command", 10,
          [this](const cell_microinjection::StringStamped& message, const std::string&) {
            commanded_ = message.string;
          },
          StampRule::kAny)) {
  if (std::filesystem::exists(parameters_.file)) take(readCalibration(parameters_.file));
  watch_.on_motion = [this](const Eigen::Vector3d& position, bool followed) {
    if (!calibration_) return;
    // Where the backlash lies after a motion that nobody watched is not known.
    if (play_ && followed) {
      play_->moveTo(position);
    } else {
      play_.emplace(calibration_->backlash(), position);
    }
  };
  watch_.on_tip = [this](const SeenTip& tip) { watchDrift(tip); };
  using std_srvs::Trigger;
  rezero_ = bus.advertiseService<Trigger>("calibration/rezero", [this](Trigger::Request&, Trigger::Response& response) {
    rezero(response);
    return true;
  });
  undo_ = bus.advertiseService<Trigger>("calibration/undo", [this](Trigger::Request&, Trigger::Response& response) {
    undo(response);
    return true;
  });
}

std::string CalibrationNode::utcNow() const {
  const std::time_t now = bus_.isVirtual() ? bus_.now().sec : std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[sizeof "YYYY-MM-DDTHH:MM:SSZ"];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

void CalibrationNode::watchDrift(const SeenTip& tip) {
  if (!calibration_ || !play_ || !play_->known(0) || !play_->known(2) || run_) return;
  if (!calibration_->refusalOf(watch_.imageSize()).empty()) return;
  if (tip.stamp < watch_.restedSince() + parameters_.calibration.pattern.settle_time) return;
  drift_report_ = drift_.add(*calibration_, play_->tip(), tip.pixel, tip.covariance);
}

CalibrationInput CalibrationNode::input() const {
  return {bus_.now().toSec(), watch_.position(), setpoint_ != goal_, watch_.tip()};
}

std::string CalibrationNode::interruption() const {
  const std::string& needle = watch_.needle().state;
  const std::string& controller = watch_.controller().state;  // empty: there is none
  if (needle != "ENABLED") return "the needle is " + (needle.empty() ? "not there" : needle) + ", must be ENABLED";
  if (!controller.empty() && controller != "DISABLED")
    return "the controller is " + controller + ", must be DISABLED: send disable on /controller/state_command";
  return watch_.cellInTheWay();
}

std::string CalibrationNode::refusal() const {
  if (!watch_.position()) return "/needle/measured_cp is silent, old or invalid";
  if (const std::string reason = interruption(); !reason.empty()) return reason;
  if (!watch_.tip()) return "the tip is not seen: " + watch_.tipReason();
  const double rest = bus_.now().toSec() - watch_.restedSince();
  if (watch_.needle().is_busy || rest < parameters_.calibration.pattern.settle_time) return "the needle is moving";
  return "";
}

void CalibrationNode::begin(const Goal& goal) {
  if (const std::string reason = refusal(); !reason.empty()) throw ConfigError(reason);
  CalibrationPatternConfig pattern = parameters_.calibration.pattern;
  if (goal.field_x != 0) pattern.field.x() = goal.field_x;
  if (goal.field_z != 0) pattern.field.y() = goal.field_z;
  pattern.validate();
  const Eigen::Vector3d start = *watch_.position();
  const Eigen::Vector3d centre = start + Eigen::Vector3d(0, 0, 0.5 * pattern.field.y() + pattern.take_up);
  // Rounding must not put the lowest waypoint below the start.
  const TravelBox above{{-kFar, -kFar, start.z() - 1e-9}, {kFar, kFar, kFar}};
  CalibrationPlan plan = planCalibration(pattern, centre, start, above);
  if (!plan.refusals.empty()) throw ConfigError(join(plan.refusals, "; "));
  // Away from the cell before it goes across.
  plan.waypoints.insert(plan.waypoints.begin(), {start + pattern.take_up * Eigen::Vector3d::UnitZ(), false, false});
  setpoint_ = goal_ = start;
  images_ = watch_.imageSize();
  commanded_.clear();
  run_ = std::make_unique<CalibrationRun>(pattern, plan);
}

void CalibrationNode::step() {
  if (!isActive()) return;
  if (const std::string reason = interruption(); !reason.empty()) return finish(false, reason);
  if (!commanded_.empty()) return finish(false, "the needle had the command " + commanded_);
  if (const std::string change = sizeChange(images_, watch_.imageSize()); !change.empty()) return finish(false, change);
  if (const auto goal = run_->step(input())) goal_ = *goal;
  if (!run_->failure().empty()) return finish(false, run_->failure());
  stream(bus_.now());
  Feedback feedback;
  feedback.waypoint = static_cast<int>(run_->waypoint());
  feedback.waypoints = static_cast<int>(run_->waypoints());
  feedback.seen = run_->seen();
  publishFeedback(feedback);
  if (run_->done()) complete();
}

void CalibrationNode::complete() {
  const CalibrationSetup setup{utcNow(), watch_.imageCentre(),
                               calibration_ ? calibration_->tips : std::vector<TipRecord>(), watch_.imageSize()};
  const CalibrationOutcome outcome = calibrate(run_->observations(), parameters_.calibration.limits, setup);
  if (!outcome.calibration) return finish(false, join(outcome.refusals, "; "));
  try {
    store(*outcome.calibration);
  } catch (const std::exception& error) {
    return finish(false, error.what());
  }
  take(*outcome.calibration);
  if (play_) {
    for (const TipObservation& observation : run_->observations()) play_->moveTo(observation.position);
  }
  finish(true, describe(*calibration_) + (outcome.warning.empty() ? "" : "; " + outcome.warning));
}

CalibrationNode::Result CalibrationNode::end(bool success) {
  run_.reset();
  return success ? toResult(*calibration_) : Result();
}

/// The next set-point on the way to the goal. Without one for command_timeout the needle stops.
void CalibrationNode::stream(const ros::Time& now) {
  const Eigen::Vector3d way = goal_ - setpoint_;
  const double reach = parameters_.calibration.pattern.speed * kCalibrationPeriod;
  setpoint_ = way.norm() <= reach ? goal_ : Eigen::Vector3d(setpoint_ + reach * way.normalized());
  setpoints_.publish(toPose(watch_.poseAt(setpoint_), now, kWorldFrame));
}

void CalibrationNode::store(const CameraCalibration& calibration) {
  writeCalibration(parameters_.file, calibration);
  replaced_ = calibration_;
}

void CalibrationNode::take(const CameraCalibration& calibration) {
  calibration_ = calibration;
  drift_.reset();
  drift_report_ = DriftReport();
  play_.reset();
  if (const auto position = watch_.position()) play_.emplace(calibration.backlash(), *position);
}

void CalibrationNode::rezero(std_srvs::Trigger::Response& response) {
  const CalibrationInput present = input();
  if (!calibration_) {
    response.message = "there is no calibration: run calibration/calibrate first";
  } else if (run_) {
    response.message = "a calibration is under way";
  } else if (!present.position || !play_) {
    response.message = "/needle/measured_cp is silent, old or invalid";
  } else if (!present.tip || present.tip->stamp < watch_.restedSince() + parameters_.calibration.pattern.settle_time) {
    response.message = present.tip ? "the needle has just moved" : "the tip is not seen: " + watch_.tipReason();
  } else if (const std::string reason = calibration_->refusalOf(watch_.imageSize()); !reason.empty()) {
    response.message = reason;
  } else {
    NewTip tip;
    tip.pixel = present.tip->pixel;
    tip.covariance = present.tip->covariance;
    const RezeroResult result = microinjection::rezero(*calibration_, tip, *play_, utcNow());
    response.message = result.calibration ? "the tip's place is new; the axes stay" : result.refusal;
    if (!result.warning.empty()) response.message += "; " + result.warning;
    if (!result.calibration) return;
    try {
      store(*result.calibration);
      calibration_ = *result.calibration;
      drift_.reset();
      response.success = 1;
    } catch (const std::exception& error) {
      response.message = error.what();
    }
  }
}

void CalibrationNode::undo(std_srvs::Trigger::Response& response) {
  if (run_) {
    response.message = "a calibration is under way";
    return;
  }
  if (!replaced_) {
    response.message = "this session has replaced no calibration";
    return;
  }
  try {
    const CameraCalibration again = *replaced_;
    store(again);
    take(again);
    response.success = 1;
    response.message = "again that of " + calibration_->date + ": " + describe(*calibration_);
  } catch (const std::exception& error) {
    response.message = error.what();
  }
}

void CalibrationNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, calibration_ ? "calibrated" : "not calibrated");
  if (run_) status.summary(diagnostic_msgs::DiagnosticStatus::OK, "calibrating");
  if (drift_report_.verdict == DriftVerdict::kDrifted)
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, "the tip has drifted: calibrate or rezero");
  if (calibration_ && !watch_.imageSize().isZero()) {
    for (const std::string& doubt : {calibration_->refusalOf(watch_.imageSize()), calibration_->warning()})
      if (!doubt.empty()) status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, doubt);
  }
  bus_.refusals().report(status);
  status.add("file", parameters_.file);
  if (calibration_) status.add("date", calibration_->date);
  if (calibration_) status.add("calibration", describe(*calibration_));
  status.add("drift", drift_report_.text);
}

}  // namespace microinjection
