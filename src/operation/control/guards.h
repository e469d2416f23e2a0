#pragma once

#include <Eigen/Core>
#include <boost/circular_buffer.hpp>
#include <optional>
#include <string>

#include "base/config_reader.h"

namespace microinjection {

/// Bounds that nothing may cross. How each is kept is the InjectionController's.
struct GuardConfig {
  double speed_limit = 200e-6;         ///< m/s, of the set-point: kept, not waited for
  double jump_limit = 100e-6;          ///< m, a target farther than this from the set-point is not followed
  double lag_limit = 10e-6;            ///< m, that a rig which follows late may be behind its set-point
  double tracking_limit = 50e-6;       ///< m between needle and set-point past which the rig is at fault
  double needle_speed_limit = 1e-3;    ///< m/s, of the needle, past which the rig is at fault
  double force_limit = 15e-6;          ///< N along the pipette, either way
  double lateral_force_limit = 15e-6;  ///< N across it: a two-axis sensor sees that less sharply
  double depth_limit = 50e-6;          ///< m past the touch
  double time_limit = 30;              ///< s, that an injection of the controller's own may spend in one state

  static GuardConfig read(ConfigReader& reader);
};

/// Speed of the needle from its measured positions over a window that is longer than a step of its encoder.
class NeedleSpeed {
 public:
  /// m/s after one more position (m), dt (s) after the last.
  double step(const Eigen::Vector3d& position, double dt);
  void reset() { past_.clear(); }

 private:
  struct Past {
    Eigen::Vector3d position;  ///< m
    double age;                ///< s
  };
  boost::circular_buffer<Past> past_{128};  ///< of the window at 5 kHz and less
};

/// How far (m) a set-point may go ahead of a needle that follows it with a lag (s): twice what the lag makes at the
/// speed limit, so that a needle that stands still, for whatever reason, does not leap when it is let go.
double followingErrorLimit(const GuardConfig& config, double lag);

/// Why the rig is at fault, by its needle, set-point (m) and speed (m/s); empty when it is not.
std::string rigFault(const GuardConfig& config, const Eigen::Vector3d& needle, const Eigen::Vector3d& setpoint,
                     double speed);
/// Why the needle may not go deeper; empty when it may. force: N, axis: of the pipette, depth: m past the touch.
std::string forceGuard(const GuardConfig& config, const Eigen::Vector3d& force, const Eigen::Vector3d& axis);
std::string depthGuard(const GuardConfig& config, double depth);
/// `state`: its word, for the reason; time: s in it.
std::string timeGuard(const GuardConfig& config, const char* state, double time);

}  // namespace microinjection
