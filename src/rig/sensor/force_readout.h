#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace microinjection {

/// Makes forces of a sensor's raw readings: force = gain (raw - tare). Both are found from averages of raw readings
/// over a time, the tare with nothing at the tip, the gain with known forces on it.
class ForceReadout {
 public:
  /// `range`: the largest force (N) of each axis of a reading, (axial, lateral) or more, that may be known in a
  /// calibration. The gain begins as 1 and the tare as 0. `averaging` in s.
  ForceReadout(const Eigen::VectorXd& range, double averaging);

  /// Takes a raw reading (N) at `time` (s), for the average that is under way, and returns the force (N).
  Eigen::VectorXd read(const Eigen::VectorXd& raw, double time);

  /// Begins to average; empty, or why not. The tare in force stays until the new one is there.
  std::string beginTare();
  /// Begins to average under a known force (N), of the reading's size: finite, not zero and within the range.
  std::string beginPoint(const Eigen::VectorXd& force);
  /// There is nothing valid to average: gives up the average under way.
  void interrupt();

  /// The gain that fits force = gain (mean - tare) to the points in the least-squares sense. Points that span all axes
  /// give the whole matrix, with the coupling of the axes; otherwise each axis that has a force gets a gain of its own,
  /// times its row of the present matrix. Refused are points that do not determine that, a gain that changes the size
  /// of a force more than a hundredfold, and a residual of more than half of the known forces (rms). Empty, or why
  /// nothing changed.
  std::string solve();
  /// Forgets points and gain: 1 again. The tare stays.
  void clear();

  bool averaging() const { return purpose_ != Purpose::kNone; }
  /// What became of the last average or calibration.
  const std::string& outcome() const { return outcome_; }
  const Eigen::MatrixXd& gain() const { return gain_; }
  const Eigen::VectorXd& tare() const { return tare_; }  ///< N
  int points() const { return static_cast<int>(points_.size()); }
  double residual() const { return residual_; }  ///< N rms over points and axes, of the last solve()

 private:
  enum class Purpose { kNone, kTare, kPoint };
  struct Point {
    Eigen::VectorXd raw, force;  ///< N
  };

  std::string begin(Purpose purpose);
  void finishAverage();
  std::string solveMatrix(const Eigen::MatrixXd& raw, const Eigen::MatrixXd& force, Eigen::MatrixXd& gain) const;
  std::string solveAxes(const Eigen::MatrixXd& raw, const Eigen::MatrixXd& force, Eigen::MatrixXd& gain) const;

  Eigen::VectorXd range_;  ///< N
  double duration_;        ///< s
  Eigen::VectorXd tare_;
  Eigen::MatrixXd gain_;
  Purpose purpose_ = Purpose::kNone;
  double began_ = -1;  ///< s; negative before the average's first reading
  int count_ = 0;
  Eigen::VectorXd sum_;
  Eigen::VectorXd known_;  ///< N, of the point under way
  std::vector<Point> points_;
  double residual_ = 0;
  std::string outcome_;
};

}  // namespace microinjection
