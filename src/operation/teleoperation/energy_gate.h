#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"

namespace microinjection {

struct EnergyGateConfig {
  double damping_limit = 20;     ///< N s/m, largest added damping; 0.9 of the device's limit of stability
  double velocity_floor = 2e-3;  ///< m/s, smallest velocity to divide by; slower is noise
  double recovery_time = 0.02;   ///< s, time to dissipate a deficit
  double return_time = 0.2;      ///< s, time in which a withheld force returns
  double fade = 2.5e-4;          ///< J of margin, below which a force that does work is reduced
  double resolution = 3e-5;      ///< m, of the device's encoders (a desktop stylus: 10 to 55 um)

  /// The keys of the same names.
  static EnergyGateConfig read(ConfigReader& reader);
};

/// Controller of time-domain passivity in impedance causality: limits the work of a force on the
/// hand to the energy margin.
///
/// It withholds a share of the force at once. The withheld share returns slowly and only while
/// there is energy. If it returned at once, it would push a resting hand by one encoder step, be
/// withheld and return again: a limit cycle that leaks energy unobserved. A deficit is dissipated
/// by damping, up to the device's limit.
class EnergyGate {
 public:
  explicit EnergyGate(const EnergyGateConfig& config) : config_(config) {}

  void reset() { *this = EnergyGate(config_); }
  /// Resets the return to return_time. Called after some time of free motion.
  void resetReturnTime() { return_time_factor_ = 1, rising_ = false; }
  /// Damping (N s/m) to dissipate `energy_deficit` (J) at a velocity (m/s).
  double damping(double energy_deficit, const Eigen::Vector3d& velocity) const;
  /// Returns the force (N) for the next dt (s). `wanted` (N) acts on the hand, which moves at
  /// `velocity` (m/s). A negative `energy_margin` (J) is a deficit.
  Eigen::Vector3d step(const Eigen::Vector3d& wanted, const Eigen::Vector3d& velocity, double energy_margin, double dt);
  bool acting() const { return acting_; }  ///< the last force differed from the wanted one

 private:
  void changeShare(double work, bool absorbs, double energy_margin, double dt);

  EnergyGateConfig config_;
  double share_ = 1;               ///< rendered share of the wanted force, 0..1
  double return_time_factor_ = 1;  ///< factor of return_time, doubled by each relapse
  bool rising_ = false;
  bool acting_ = false;
};

}  // namespace microinjection
