#include "vision/calibration/calibration_run.h"

#include <sstream>

namespace microinjection {
namespace {

constexpr double kAtWaypoint = 1e-6;  // m, from the target: motors differ from a command by their resolution
constexpr double kSlow = 4;           // times the planned duration of a move, before it counts as failed
constexpr double kPatience = 3;       // s, on top: a device needs time to begin and to report
constexpr int kMostUnseen = 10;       // points in a row: one side of a pattern may lie outside of the image
constexpr double kUnseen = 5;         // times observation_time, in which a tip that was not seen may still come

}  // namespace

CalibrationRun::CalibrationRun(const CalibrationPatternConfig& config, const CalibrationPlan& plan)
    : config_(config), plan_(plan) {}

bool CalibrationRun::arrived(const CalibrationInput& input) const {
  return !input.busy && input.position && (*input.position - plan_.waypoints[next_].position).norm() < kAtWaypoint;
}

std::optional<Eigen::Vector3d> CalibrationRun::step(const CalibrationInput& input) {
  if (done() || !failure_.empty()) return std::nullopt;
  const CalibrationWaypoint& waypoint = plan_.waypoints[next_];
  const double elapsed = input.now - since_;
  if (!input.position) {
    failure_ = "the needle's position is not known";
    return std::nullopt;
  }
  if ((phase_ == Phase::kSettle || phase_ == Phase::kObserve) && !arrived(input)) {
    failure_ = "the needle has left waypoint " + std::to_string(next_ + 1) + " by itself";
    return std::nullopt;
  }
  switch (phase_) {
    case Phase::kCommand:
      allowed_ = kPatience + kSlow * (waypoint.position - *input.position).norm() / config_.speed;
      since_ = input.now;
      phase_ = Phase::kMove;
      return waypoint.position;
    case Phase::kMove:
      if (arrived(input)) {
        since_ = input.now;
        phase_ = Phase::kSettle;
      } else if (elapsed > allowed_) {
        std::ostringstream text;
        text << "waypoint " << next_ + 1 << " of " << waypoints() << " was not reached within " << allowed_ << " s";
        failure_ = text.str();
      }
      return std::nullopt;
    case Phase::kSettle:
      if (elapsed < config_.settle_time) return std::nullopt;
      if (!waypoint.observe) {
        finish();
        return std::nullopt;
      }
      since_ = input.now;
      phase_ = Phase::kObserve;
      return std::nullopt;
    case Phase::kObserve:
      collect(input);
      if (elapsed >= config_.observation_time * (tips_.empty() ? kUnseen : 1)) finish();
      return std::nullopt;
  }
  return std::nullopt;
}

void CalibrationRun::collect(const CalibrationInput& input) {
  if (!input.tip || input.tip->stamp < since_ || input.tip->stamp > input.now) return;
  if (!tips_.empty() && input.tip->stamp <= tips_.back().stamp) return;
  tips_.push_back(*input.tip);
}

void CalibrationRun::finish() {
  TipObservation observation;
  observation.position = plan_.waypoints[next_].position;
  if (plan_.waypoints[next_].observe) unseen_ = tips_.empty() ? unseen_ + 1 : 0;
  if (unseen_ >= kMostUnseen)
    failure_ = "the tip was not seen at " + std::to_string(unseen_) + " points in a row: the camera may have stopped";
  if (!tips_.empty()) {
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
    for (const SeenTip& tip : tips_) {
      pixel += tip.pixel / static_cast<double>(tips_.size());
      covariance += tip.covariance / static_cast<double>(tips_.size());
    }
    observation.pixel = pixel;
    observation.covariance = covariance;
    ++seen_;
  }
  observations_.push_back(observation);
  tips_.clear();
  phase_ = Phase::kCommand;
  ++next_;
}

}  // namespace microinjection
