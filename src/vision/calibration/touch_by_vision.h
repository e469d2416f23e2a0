#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "vision/calibration/statistics.h"

namespace microinjection {

struct TouchByVisionConfig {
  int least_points = 5;            ///< samples on either side of the touch
  double least_change = 1;         ///< px, by which the last sample must leave the line before the touch
  double false_rate = 1e-3;        ///< 1, touches found in a series without one
  double exponent = 1;             ///< p, of the change past the touch
  double largest_interval = 1e-6;  ///< m, largest half width of the touch height's 95 % interval

  static TouchByVisionConfig read(ConfigReader& reader);
};

/// One height of an approach and what was seen there.
struct TouchSample {
  double height = 0;                                ///< m, commanded; all in one direction
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< px: the tip, or a point of what is touched
  double deviation = 1;                             ///< of a coordinate, relative to that of other samples
};

/// Coordinates of TouchSample::pixel that were measured: both, or only x.
enum class TouchCoordinates { kOne = 1, kTwo = 2 };

enum class TouchVerdict {
  kTouch,    ///< at `height`
  kNoTouch,  ///< no touch in this range
  kUnsure,   ///< there is a bend, but too close to an end or too vague
  kInvalid,  ///< the samples are unusable
};

struct TouchReport {
  TouchVerdict verdict = TouchVerdict::kInvalid;
  double height = 0;  ///< m
  Interval interval;  ///< m, 95 %
  double change = 0;  ///< px/m, by which the touch changed the motion of the pixel in the first um
  std::string text;   ///< one sentence with numbers
};

/// Finds the height at which the motion of what is seen changes. With t the way along the approach
///     pixel = a + c t                         before the touch at tau,
///     pixel = a + c t + k (t - tau)^p         after it.
/// A stop or a flat tip on an elastic body has p = 1, a round tip 1.5 (Hertz).
/// A fit of least distances over tau finds outliers; least squares without them gives tau. Both weigh
/// a sample by its deviation. The interval is that of the profile: S(tau) <= S_min (1 + F(1, nu) / nu). There is a
/// touch when an F test prefers two segments, at the false rate over the number of heights tried.
TouchReport findTouch(const std::vector<TouchSample>& samples, const TouchByVisionConfig& config,
                      TouchCoordinates coordinates = TouchCoordinates::kTwo);

}  // namespace microinjection
