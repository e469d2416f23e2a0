#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "base/config_reader.h"
#include "vision/calibration/camera_calibration.h"

namespace microinjection {

struct ImageTargetConfig {
  double gain = 0.5;            ///< 1, share of the error that a step removes
  double largest_step = 5e-6;   ///< m, of the tip; taking up the backlash comes on top
  double largest_age = 0.2;     ///< s, of an image when the step is computed
  double tolerance = 0.7;       ///< px, distance at which the tip has arrived
  double largest_jump = 40e-6;  ///< m, between where the tip is seen and where the calibration expects it

  static ImageTargetConfig read(ConfigReader& reader);
};

/// The tip as one image shows it.
struct TipFrame {
  std::uint64_t sequence = 0;                     ///< of the image, increasing
  double stamp = 0;                               ///< s, when it was exposed
  Eigen::Vector2d tip = Eigen::Vector2d::Zero();  ///< px
};

struct ImageStep {
  std::optional<Eigen::Vector3d> position;  ///< m, next position of the motors; none: no motion
  bool arrived = false;                     ///< the tip is at the target
  std::string reason;                       ///< why there is no motion; empty when there is
};

/// Brings the tip to a pixel, image by image. Each step moves the tip's place by the gain times the
/// error in the image. No motion rests on an image that is stale, out of order, of the future, or
/// exposed before the last step was finished.
class ImageTarget {
 public:
  explicit ImageTarget(const ImageTargetConfig& config) : config_(config) {}

  /// `play` has the manipulator's backlash and position; its axes x and z must be known. `now` (s)
  /// on the clock of the stamps. `rested_since` (s): when the manipulator last came to rest.
  ImageStep step(const TipFrame& frame, const Eigen::Vector2d& target, const CameraCalibration& calibration,
                 const Play& play, double now, double rested_since);
  /// Accepts any sequence number next, for a camera that was restarted.
  void reset() { last_.reset(); }

 private:
  std::string refusalOf(const TipFrame& frame, const Play& play, double now, double rested_since) const;

  ImageTargetConfig config_;
  std::optional<TipFrame> last_;  ///< newest frame that was accepted
};

}  // namespace microinjection
