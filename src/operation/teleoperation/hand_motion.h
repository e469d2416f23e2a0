#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace microinjection {

/// A hand's motion over time, recorded or synthetic: intended position, clutch and phase of the
/// task.
class HandMotion {
 public:
  struct Sample {
    double time = 0;                                     ///< s, from the start of the motion
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, haptic device
    bool clutch = false;                                 ///< pressed
    std::string phase;                                   ///< for people: approach, touch, indent, ...
  };

  /// Reads a motion. A .yaml file describes a synthetic one, see generated_motion.h. Any other file
  /// has samples `time_s,x_m,y_m,z_m,clutch,phase` below a header line; lines that begin with # are
  /// comments.
  /// @throws ConfigError naming file and key or line: wrong header, not a number, not finite, time
  /// that does not increase.
  static HandMotion load(const std::string& path);

  /// @throws ConfigError without two samples, or when time does not increase.
  explicit HandMotion(std::vector<Sample> samples);

  double duration() const { return samples_.back().time; }  ///< s

  /// Interpolates the position; clutch and phase are those of the sample before. Constant beyond
  /// both ends.
  Sample at(double time) const;

 private:
  std::vector<Sample> samples_;
};

}  // namespace microinjection
