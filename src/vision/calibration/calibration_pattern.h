#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/config_reader.h"

namespace microinjection {

/// The pattern that the needle is moved on.
struct CalibrationPatternConfig {
  Eigen::Vector2d field{100e-6, 100e-6};  ///< m, extent in x and z
  int columns = 5;                        ///< points along x
  int rows = 6;                           ///< and along z
  double take_up = 8e-6;                  ///< m, of a move that takes up the play; above the largest backlash
  double depth = 0;                       ///< m, travel of axis y to either side of the centre; 0: no focus readings
  double speed = 100e-6;                  ///< m/s
  double settle_time = 0.1;               ///< s, at rest at each waypoint before it is observed
  double observation_time = 0.2;          ///< s, of seeing the tip
  double focus_time = 2;                  ///< s, of a focus reading
  double duration_limit = 60;             ///< s, of the whole session

  static CalibrationPatternConfig read(ConfigReader& reader);
  /// Throws ConfigError with all errors.
  void validate() const;
};

struct CalibrationWaypoint {
  Eigen::Vector3d position;  ///< m, of the motors; reached in one straight move
  bool observe = false;      ///< see the tip here
  bool focus = false;        ///< read its best focus as well
};

struct CalibrationPlan {
  std::vector<CalibrationWaypoint> waypoints;  ///< empty when it was refused
  int observations = 0;
  int focus_readings = 0;
  double duration = 0;                ///< s, estimate: moves, settling, observations
  std::vector<std::string> refusals;  ///< name, value and what is allowed
};

/// Volume that the needle may move in.
struct TravelBox {
  Eigen::Vector3d low, high;  ///< m
};

/// Plans a there-and-back meander over the field in (x, z). Going up, rows alternate in direction;
/// it then overshoots and comes back over the same points. So each point is seen with both
/// directions of x and of z, uncorrelated with its place: backlash and scale separate. With a
/// depth, axis y then goes up and down at the centre, and focus is read there and in the corners.
/// `start` (m): where the needle is. Refuses a waypoint outside of `box` and a plan that takes too
/// long. `config` must be valid.
CalibrationPlan planCalibration(const CalibrationPatternConfig& config, const Eigen::Vector3d& centre,
                                const Eigen::Vector3d& start, const TravelBox& box);

}  // namespace microinjection
