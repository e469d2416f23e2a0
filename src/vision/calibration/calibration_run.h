#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "vision/calibration/calibration_config.h"
#include "vision/calibration/calibration_data.h"

namespace microinjection {

/// A tip as an image shows it.
struct SeenTip {
  double stamp = 0;                                      ///< s, exposure of the image
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();       ///< px
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< px^2
};

/// What a step of a run knows. Times are of one clock, s.
struct CalibrationInput {
  double now = 0;
  std::optional<Eigen::Vector3d> position;  ///< m, of the motors; none: not known now
  bool busy = false;                        ///< a move is under way
  std::optional<SeenTip> tip;               ///< newest; none: not seen in the newest image
};

/// Moves the needle over the plan's waypoints and collects where its tip is seen.
///
/// A tip counts when its image was exposed at rest, after settle_time. The waypoint's pixel is the
/// mean of the images of observation_time; its covariance is the mean of the stated ones, not
/// divided: what misleads the detector in one image misleads it in the next, and the fit scales it.
/// A late tip is waited for, up to 5 observation_time. A waypoint without one has no pixel. The run
/// fails when a move does not arrive, the position is lost, or the needle leaves a waypoint by itself.
class CalibrationRun {
 public:
  /// `plan` has waypoints.
  CalibrationRun(const CalibrationPatternConfig& config, const CalibrationPlan& plan);

  /// Returns the next position (m) of the motors when a new move is to be commanded, once each.
  std::optional<Eigen::Vector3d> step(const CalibrationInput& input);

  bool done() const { return next_ == plan_.waypoints.size() && failure_.empty(); }
  const std::string& failure() const { return failure_; }  ///< empty: none
  std::size_t waypoint() const { return next_; }           ///< index of the present one; their number when done
  std::size_t waypoints() const { return plan_.waypoints.size(); }
  int seen() const { return seen_; }  ///< waypoints with a pixel
  /// Of the waypoints that are done, in the order of the moves.
  const std::vector<TipObservation>& observations() const { return observations_; }

 private:
  enum class Phase { kCommand, kMove, kSettle, kObserve };

  bool arrived(const CalibrationInput& input) const;
  void collect(const CalibrationInput& input);
  void finish();

  CalibrationPatternConfig config_;
  CalibrationPlan plan_;
  Phase phase_ = Phase::kCommand;
  std::size_t next_ = 0;
  double since_ = 0;           ///< s, begin of the phase
  double allowed_ = 0;         ///< s, of the move
  std::vector<SeenTip> tips_;  ///< of this waypoint
  std::vector<TipObservation> observations_;
  int seen_ = 0, unseen_ = 0;  ///< points; the second: in a row
  std::string failure_;
};

}  // namespace microinjection
