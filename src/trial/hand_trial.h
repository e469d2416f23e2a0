#pragma once

#include <Eigen/Core>
#include <array>
#include <deque>
#include <memory>
#include <string>

#include "operation/control/training_score.h"
#include "trial/injection_case.h"
#include "trial/injection_rig.h"

namespace microinjection {

/// What all cells of trials are made from.
struct TrialCell {
  Scene scene;
  std::shared_ptr<const SurrogateData> data;
  std::string urdf;  ///< path, of the rig
};

/// Throws ConfigError for a file that cannot be read.
ManipulatorGeometry geometryOf(const std::string& urdf_path);

/// With a probability of `share` one fault that an operator meets: a sensor that is frozen, jumps (0.1 to 1 times the
/// zona's strength) or drifts (0.02 to 0.2 times it a second), set-points that are lost for 3 s or are 0.05 to 0.3 s
/// late, or a needle that drifts (0.1 to 1 um/s). It begins 0.5 to 8 s after the start.
InjectionRig::Disturbance randomFault(const InjectionCase& of, double share);
/// As a word; empty: none.
std::string toText(InjectionRig::Disturbance::Kind kind);

/// A random cell that somebody else injects: a hand, or a program that learns to. Its motion goes the way of an
/// operator's, through the controller with its guards, and what it hears comes from the virtual sensor, so that a
/// policy that works here has met the noise, the delays and the refusals of a session, at a hundredth of the time.
///
///     velocity --> target --> InjectionController (manual) --> Micromanipulator --> cell --> ForceSensor -->
///     observation
///
/// The same seed and the same steps give the same bits.
class HandTrial {
 public:
  struct Config {
    int seed = 0;
    double force_delay = 0;  ///< s, of the sensor's reading
    double noise = 1;        ///< of the sensor's noise and drift, over that of ForceSensorConfig
    double faults = 0;       ///< probability of a fault of the rig, see randomFault()
  };
  /// Names and units of an observation's numbers.
  static constexpr std::array<const char*, 14> kObservation = {
      "time_s", "x_m",       "y_m",       "z_m",        "force_axial_N",      "force_lateral_N", "depth_m",
      "state",  "punctures", "volume_m3", "diameter_m", "assumed_modulus_Pa", "force_limit_N",   "depth_limit_m"};
  using Observation = Eigen::Matrix<double, kObservation.size(), 1>;
  static constexpr double kLongest = 120;     ///< s, after which a trial is over
  static constexpr double kFastest = 200e-6;  ///< m/s, of a target along an axis

  HandTrial(const TrialCell& cell, const Config& config);

  /// Moves the target by `velocity` (m/s, in world: z away from the cell) for `steps` of 1 ms. @throws ConfigError for
  /// one that is not finite or faster than kFastest, and for a trial that is over
  void step(const Eigen::Vector3d& velocity, bool inject, int steps);

  /// x, y and z count from the start. Without a contact the depth is 0.
  Observation observation() const;
  /// The needle was in the cell and is out again, the controller is in FAULT, or the time is.
  bool over() const { return over_; }
  std::string state() const { return toText(rig_->controller().injection()); }
  const std::string& notice() const { return notice_; }  ///< why the last command was refused; empty: it was not
  double trueForce() const { return true_force_; }       ///< N, along the pipette
  int seed() const { return of_.seed; }
  Eigen::Vector3d trueTip() const { return rig_->tip(); }  ///< m
  const InjectionRig::Disturbance& fault() const { return fault_; }
  const TrainingTask& task() const { return task_; }
  TrainingScore score() const { return training_.score(task_); }

 private:
  InjectionCase of_;
  InjectionRig::Disturbance fault_;
  InjectionControllerConfig settings_;
  TrainingTask task_;
  std::unique_ptr<ScaledCell> cell_;
  std::unique_ptr<InjectionRig> rig_;
  TrainingSession training_;
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero(), target_ = start_;  ///< m
  std::deque<Eigen::Vector2d> readings_;                               ///< N, the newest last
  std::size_t delay_ = 0;                                              ///< readings
  std::string notice_;
  double true_force_ = 0;
  bool touched_ = false, over_ = false;
};

}  // namespace microinjection
