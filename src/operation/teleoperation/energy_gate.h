#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"

namespace microinjection {

struct EnergyGateConfig {
  double damping_limit = 20;     ///< N s/m, the most that is added; 0.9 of what the device stays stable with
  double velocity_floor = 2e-3;  ///< m/s, below which the velocity is noise and is not divided by
  double recovery_time = 0.02;   ///< s, within which a deficit is to be dissipated
  double return_time = 0.2;      ///< s, over which a force that was withheld comes back
  double fade = 2.5e-4;          ///< J left, below which a force that does work becomes smaller
  double resolution = 3e-5;      ///< m, of the device's encoders (a desktop stylus: 10 to 55 um)

  /// The keys of the same names.
  static EnergyGateConfig read(ConfigReader& reader);
};

/// The controller's half of time-domain passivity in impedance causality: lets a force do no more work on the hand than
/// there is energy to spare.
///
/// It withholds and it damps. Withholding (a share of the force) is at once, and what was withheld comes back slowly
/// and only while there is energy: at rest a force that came back at once would push the hand by a step of its encoder,
/// be withheld, and come back again, a limit cycle that leaks energy unseen. Damping makes good what is owed,
/// no stronger than the device can.
class EnergyGate {
 public:
  explicit EnergyGate(const EnergyGateConfig& config) : config_(config) {}

  void reset() { *this = EnergyGate(config_); }
  /// After a while in free motion: what is withheld next comes back within return_time again.
  void trust() { patience_ = 1, rising_ = false; }
  /// Damping (N s/m) to dissipate `energy_deficit` (J) at a velocity (m/s).
  double damping(double energy_deficit, const Eigen::Vector3d& velocity) const;
  /// `wanted` (N, on the hand), its `velocity` (m/s), the `energy_margin` (J, negative: a deficit),
  /// dt (s) ahead.
  Eigen::Vector3d step(const Eigen::Vector3d& wanted, const Eigen::Vector3d& velocity, double energy_margin, double dt);
  bool acting() const { return acting_; }  ///< the last force was not the one that was wanted

 private:
  void changeShare(double work, bool absorbs, double energy_margin, double dt);

  EnergyGateConfig config_;
  double share_ = 1;     ///< of the wanted force, 0..1
  double patience_ = 1;  ///< times return_time
  bool rising_ = false;
  bool acting_ = false;
};

}  // namespace microinjection
