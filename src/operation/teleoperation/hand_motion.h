#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace microinjection {

/// A hand's motion over time, recorded or synthetic: where the hand means to be, its clutch and what it is doing.
class HandMotion {
 public:
  struct Sample {
    double time = 0;                                     ///< s, from the start of the motion
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, haptic device
    bool clutch = false;                                 ///< pressed
    std::string phase;                                   ///< for people: approach, touch, indent, ...
  };

  /// Of a .yaml file: synthetic, see generated_motion.h. Of any other: samples `time_s,x_m,y_m,z_m,clutch,phase` with a
  /// header line; lines that begin with # are comments.
  /// @throws ConfigError naming file and key or line: wrong header, not a number, not finite, time that does not
  /// increase.
  static HandMotion load(const std::string& path);

  /// @throws ConfigError without two samples, or when time does not increase.
  explicit HandMotion(std::vector<Sample> samples);

  double duration() const { return samples_.back().time; }  ///< s

  /// Position linear between samples; clutch and phase of the sample before. Held at both ends.
  Sample at(double time) const;

 private:
  std::vector<Sample> samples_;
};

}  // namespace microinjection
