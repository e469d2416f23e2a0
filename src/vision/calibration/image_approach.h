#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "vision/calibration/calibration_run.h"
#include "vision/calibration/image_target.h"
#include "vision/calibration/play.h"
#include "vision/calibration/setpoint_stream.h"

namespace microinjection {

struct ImageApproachConfig {
  double speed = 50e-6;      ///< m/s, of the set-point
  double settle_time = 0.1;  ///< s, at rest before an image counts
  double time_limit = 60;    ///< s
  ImageTargetConfig target;

  /// Reads speed, settle_time, time_limit and the section image_target.
  static ImageApproachConfig read(ConfigReader& reader);
};

/// Brings the tip to a pixel: a stream of set-points for a controller that follows them, with the
/// next step from each image at rest (ImageTarget).
///
/// First it takes the backlash up, by a motion away from the cell (upwards) and one across. Without a
/// new image the set-point stays.
class ImageApproach {
 public:
  struct Input {
    double now = 0;                           ///< s
    std::optional<Eigen::Vector3d> position;  ///< m, of the motors; none: not known now
    double rested_since = 0;                  ///< s, when the needle came to rest
    std::optional<SeenTip> tip;               ///< newest
  };

  /// `position`: m, of the motors, where the set-points begin; `now`: s.
  ImageApproach(const ImageApproachConfig& config, const CameraCalibration& calibration, const Eigen::Vector2d& target,
                const Eigen::Vector3d& position, double now);

  /// The set-point (m, of the motors); none once it is done or has failed.
  std::optional<Eigen::Vector3d> step(const Input& input);

  bool done() const { return done_; }                         ///< the tip is seen at the target
  const std::string& failure() const { return failure_; }     ///< empty: none
  double distance() const { return distance_; }               ///< px, of the last image; NaN before
  const std::string& waitsFor() const { return waits_for_; }  ///< empty while it moves

 private:
  void plan(const Input& input);

  ImageApproachConfig config_;
  CameraCalibration calibration_;
  Eigen::Vector2d pixel_;
  ImageTarget images_;
  Play play_;
  SetpointStream stream_;
  Eigen::Vector3d setpoint_, goal_;  ///< m
  double began_, stepped_;           ///< s
  std::uint64_t sequence_ = 0;       ///< of the images that were offered
  double last_stamp_ = -1;           ///< s
  int taken_up_ = 0;                 ///< motions that take up the backlash, of 2
  double distance_;
  bool done_ = false;
  std::string refusal_;  ///< of the last image; empty: it led to a step
  std::string failure_, waits_for_;
};

}  // namespace microinjection
