#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hardware/sensor/sensor_calibration.h"

namespace microinjection {

/// Converts a sensor's raw readings to forces: force = gain (raw - tare). Tare and gain come from
/// averages of raw readings: the tare without load, the gain under known forces.
class ForceReadout {
 public:
  /// `range` (N): the largest known force that a calibration accepts, for each axis of a reading:
  /// (axial, lateral) or more. `averaging` (s): duration of an average. The gain starts as the
  /// identity and the tare as 0.
  ForceReadout(const Eigen::VectorXd& range, double averaging);

  /// Returns the force (N) of a raw reading (N) at `time` (s). Adds the reading to an average that
  /// is under way.
  Eigen::VectorXd read(const Eigen::VectorXd& raw, double time);

  /// Starts averaging for a new tare. Returns an empty text, or the reason for a refusal. The
  /// previous tare applies until the average is complete.
  std::string beginTare();
  /// Starts averaging under a known force (N). The force has the size of a reading, is finite, not
  /// zero and within the range.
  std::string beginPoint(const Eigen::VectorXd& force);
  /// Aborts the average under way because no reading is valid.
  void interrupt(const char* reason);

  /// Fits force = gain (mean - tare) to the calibration points by least squares. Points that span
  /// all axes give the whole matrix, including the coupling between axes. Otherwise each axis with
  /// a known force gets a factor for its row of the present matrix. Refuses points that do not
  /// determine the gain, a gain that changes the size of a force more than a hundredfold, and a
  /// residual above half of the known forces (rms). Returns an empty text, or the reason why
  /// nothing changed.
  std::string solve();
  /// Deletes the points and resets the gain to the identity. The tare stays.
  std::string clear();
  /// Takes back the last step that is not taken back: a tare, a point, a gain, a clearing. Returns an empty text, or
  /// the reason why nothing changed.
  std::string undo();

  SensorCalibration calibration() const;
  /// Continues with a calibration of before. It has no points, and cannot be taken back.
  void restore(const SensorCalibration& calibration);
  /// Grows with each change of tare or gain but restore().
  unsigned changes() const { return changes_; }

  bool averaging() const { return purpose_ != Purpose::kNone; }
  /// Result of the last average or calibration.
  const std::string& outcome() const { return outcome_; }
  const Eigen::MatrixXd& gain() const { return gain_; }
  const Eigen::VectorXd& tare() const { return tare_; }    ///< N
  const Eigen::VectorXd& noise() const { return noise_; }  ///< N rms, of the readings of the last average
  int points() const { return static_cast<int>(points_.size()); }
  double residual() const { return residual_; }  ///< N rms over points and axes, of the last solve()

 private:
  enum class Purpose { kNone, kTare, kPoint };
  struct Point {
    Eigen::VectorXd raw, force;  ///< N
  };

  /// What undo() restores.
  struct Step {
    Eigen::VectorXd tare;
    Eigen::MatrixXd gain;
    std::vector<Point> points;
    double residual;
    int fitted;
  };

  std::string begin(Purpose purpose);
  void finishAverage();
  void remember();
  void reportAverage();
  std::string solveMatrix(const Eigen::MatrixXd& raw, const Eigen::MatrixXd& force, Eigen::MatrixXd& gain) const;
  std::string solveAxes(const Eigen::MatrixXd& raw, const Eigen::MatrixXd& force, Eigen::MatrixXd& gain) const;

  Eigen::VectorXd range_;  ///< N
  double duration_;        ///< s
  Eigen::VectorXd tare_;
  Eigen::MatrixXd gain_;
  Purpose purpose_ = Purpose::kNone;
  double began_ = -1;  ///< s, time of the average's first reading; negative before it
  int count_ = 0;
  Eigen::VectorXd sum_, squares_, first_,
      noise_;                    ///< of the average; squares of the differences from its first reading
  Eigen::VectorXd known_force_;  ///< N, of the point that is being averaged
  std::vector<Point> points_;
  std::vector<Step> steps_;
  unsigned changes_ = 0;
  double residual_ = 0;
  int fitted_ = 0;  ///< points of the gain
  std::string outcome_;
};

}  // namespace microinjection
