#pragma once

#include <Eigen/Core>
#include <string>

#include "base/config_reader.h"

namespace microinjection {

struct ApproachConfig {
  double approach_speed = 20e-6;  ///< m/s, until the cell is touched
  double contact_force = 50e-9;   ///< N along the pipette that counts as touch
  double travel_limit = 60e-6;    ///< m, to look for the cell in before giving up
  double depth = 10e-6;           ///< m, of the indentation after the touch
  double indent_speed = 5e-6;     ///< m/s
  double hold_time = 1.0;         ///< s, at depth
  double retract_speed = 20e-6;   ///< m/s, back to the start

  static ApproachConfig read(ConfigReader& reader);
};

/// A straight path along the pipette's axis without a hand: approach until the cell is touched, indent, hold, retract.
class Approach {
 public:
  enum class Phase { kApproach, kIndent, kHold, kRetract, kDone };

  explicit Approach(const ApproachConfig& config) : config_(config) {}

  /// Begins at `start` (m, `world`).
  void start(const Eigen::Vector3d& start);

  /// Where the tip shall be after dt (s). `axis`: unit, out of the cell; `force` (N): of the cell on the tip.
  Eigen::Vector3d step(const Eigen::Vector3d& axis, const Eigen::Vector3d& force, double dt);

  void withdraw();  ///< gives up what it was doing and goes back to the start
  void end() { phase_ = Phase::kDone; }

  Phase phase() const { return phase_; }
  bool done() const { return phase_ == Phase::kDone; }
  bool touched() const { return touched_; }  ///< false at the end: no cell was found within travel_limit

 private:
  ApproachConfig config_;
  Phase phase_ = Phase::kDone;
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();  ///< m
  double travel_ = 0;                                ///< m, from start_ into the cell
  double touch_travel_ = 0;                          ///< m
  double held_ = 0;                                  ///< s
  bool touched_ = false;
};

}  // namespace microinjection
