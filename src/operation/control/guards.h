#pragma once

#include <Eigen/Core>
#include <boost/circular_buffer.hpp>
#include <optional>
#include <string>

#include "base/config_reader.h"

namespace microinjection {

/// Limits of force, motion and time. InjectionController describes the reaction to each.
struct GuardConfig {
  double speed_limit = 200e-6;         ///< m/s, of the set-point, which never moves faster
  double jump_limit = 100e-6;          ///< m, a target farther from the set-point is not followed
  double lag_limit = 10e-6;            ///< m, largest lag of a slow rig behind its set-point
  double tracking_limit = 50e-6;       ///< m between needle and set-point, above which the rig is in FAULT
  double needle_speed_limit = 1e-3;    ///< m/s, of the needle, above which the rig is in FAULT
  double force_limit = 15e-6;          ///< N along the pipette, in both directions
  double lateral_force_limit = 15e-6;  ///< N across it, which a two-axis sensor measures less exactly
  double depth_limit = 50e-6;          ///< m past the contact point
  double time_limit = 30;              ///< s in one state of an injection that the controller moves

  static GuardConfig read(ConfigReader& reader);
};

/// Speed of the needle from its measured positions over a window that is longer than a step of its
/// encoder.
class NeedleSpeed {
 public:
  /// Adds a position (m), dt (s) after the last. Returns the speed (m/s).
  double step(const Eigen::Vector3d& position, double dt);
  void reset() { past_.clear(); }

 private:
  struct Past {
    Eigen::Vector3d position;  ///< m
    double age;                ///< s
  };
  boost::circular_buffer<Past> past_{128};  ///< holds the window at up to 5 kHz
};

/// Largest distance (m) of a set-point from a needle that follows it with a lag (s): twice the
/// distance of the lag at the speed limit. A needle that was blocked does not jump when it is
/// freed.
double followingErrorLimit(const GuardConfig& config, double lag);

/// Reason for FAULT, from needle (m), set-point (m) and speed (m/s); empty: none.
std::string rigFault(const GuardConfig& config, const Eigen::Vector3d& needle, const Eigen::Vector3d& setpoint,
                     double speed);
/// Reason against going deeper; empty: none. force: N, axis: of the pipette, depth: m past the
/// contact point.
std::string forceGuard(const GuardConfig& config, const Eigen::Vector3d& force, const Eigen::Vector3d& axis);
/// Why a force (N) of the sensor is none of a cell but a fault of the sensor, or of its unit; empty: it may be one.
/// `predicted` (N): what the cell's model exerts, if that is known.
std::string sensorFault(const GuardConfig& config, const Eigen::Vector3d& force, const Eigen::Vector3d& axis,
                        const std::optional<Eigen::Vector3d>& predicted);
std::string depthGuard(const GuardConfig& config, double depth);
/// `state`: its name, for the reason; time: s in it.
std::string timeGuard(const GuardConfig& config, const char* state, double time);

}  // namespace microinjection
