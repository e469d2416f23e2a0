#pragma once

#include <Eigen/Core>
#include <array>

#include "base/config_reader.h"
#include "hardware/sensor/noise.h"
#include "hardware/sensor/overload_latch.h"

namespace microinjection {

/// Pairs are (axial, lateral): along and across the pipette. Defaults are illustrative figures of a
/// two-axis capacitive MEMS cellular force sensor (after Sun and Nelson): 10 and 240 nN rms in the
/// 5 kHz band of its samples.
struct ForceSensorConfig {
  Eigen::Vector2d range{490e-6, 900e-6};  ///< N, of a reading
  Eigen::Vector2d overload{2e-3, 4e-3};   ///< N, on the tip; above the range; beyond it the sensor may be damaged
  Eigen::Vector2d density{1.4142e-10, 3.3941e-9};  ///< N/sqrt(Hz), one-sided; see NoiseConfig
  double flicker_corner = 0;                       ///< Hz, see NoiseConfig
  Eigen::Vector2d random_walk{0.5e-9, 2e-9};       ///< N/sqrt(s)
  Eigen::Vector2d drift_rate{0.5e-9, 2e-9};        ///< N/s
  double natural_frequency = 1500;                 ///< Hz, of the second-order response
  double damping_ratio = 0.7;                      ///< 1
  Eigen::Matrix2d sensitivity =
      (Eigen::Matrix2d() << 1, 0.02, 0.02, 1)
          .finished();         ///< reading per force; the identity except for gain and cross-axis errors
  int bits = 16;               ///< of the converter
  double sample_rate = 10000;  ///< Hz, of the converter; between samples the reading is held
  int seed = 1;                ///< of the noise

  static ForceSensorConfig read(ConfigReader& reader);
  /// Whether a sensor that lives may repeat readings that are taken at `rate` (Hz): on both axes the noise of a sample
  /// is below 0.65 of the converter's step, or a sample is read more than once.
  bool mayRepeat(double rate) const;
};

/// Model of a two-axis force sensor at the pipette. Its mechanics respond to the force on the tip,
/// the axes couple, the electronics add noise and drift, and the converter samples, saturates and
/// rounds.
class ForceSensor {
 public:
  explicit ForceSensor(const ForceSensorConfig& config);

  /// Advances by dt (s) under a constant tip force (N), (axial, lateral). Returns the newest
  /// reading (N). The result is exact for any ratio of dt to the sample period.
  /// @pre The force is finite. The caller must not publish a reading of an invalid force.
  Eigen::Vector2d sample(const Eigen::Vector2d& force, double dt);

  /// True if the last reading was clipped at the range of an axis.
  bool saturated() const { return saturated_; }
  /// True after the deflection exceeded the overload, until reset().
  bool overloaded() const { return overload_.latched(); }
  std::string overloadText() const { return overload_.text(); }
  void reset() { overload_.reset(); }

 private:
  void respond(const Eigen::Vector2d& force, double dt);
  void convert();

  ForceSensorConfig config_;
  StandardNormal normal_;
  std::array<Noise, 2> noise_;
  OverloadLatch overload_;
  Eigen::Matrix2d state_ = Eigen::Matrix2d::Zero();       ///< column per axis: deflection as force (N), its rate (N/s)
  Eigen::Matrix2d transition_ = Eigen::Matrix2d::Zero();  ///< of the deviation from equilibrium over transition_dt_
  double transition_dt_ = 0;                              ///< s
  double to_sample_;                                      ///< s, until the converter's next sample
  Eigen::Vector2d reading_ = Eigen::Vector2d::Zero();     ///< N
  bool saturated_ = false;
};

}  // namespace microinjection
