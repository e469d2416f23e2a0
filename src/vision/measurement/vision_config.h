#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "vision/track/specimen_tracker.h"

namespace microinjection {

/// How cells are found and measured in images: config/vision.yaml. The node `vision` and the command
/// `measure_cell` take the same file.
struct VisionConfig {
  std::string calibration;     ///< file, see calibrationPath()
  double pixel_size = 0;       ///< m of the specimen; 0: that of the calibration
  double image_timeout = 0.5;  ///< s
  double serve_timeout = 5;    ///< s, in which cell_simulator answers
  bool overlay = true;
  int measured_images = 15;
  std::string eyes = "both";  ///< both, or geometry: without the network that tells where things are
  SpecimenTrackerConfig tracker;

  static constexpr int kLeastImages = 3;  ///< of a measurement in a stream of images

  /// What read() gives without any key. The pipettes' detectors have other defaults.
  static VisionConfig standard();
  static VisionConfig read(ConfigReader& reader);
  /// Reads a file of its own, as config/vision.yaml. Throws ConfigError.
  static VisionConfig load(const std::string& path);
  /// The second eye that is asked for; may be none.
  std::shared_ptr<SecondEye> secondEye() const;
  /// m of the specimen, for images of this width and height (px; 0: not known yet). Throws ConfigError when it is not
  /// known, or the calibration is of images of another size. `warning`: the calibration's, see CameraCalibration.
  double pixelSize(const Eigen::Vector2i& image, std::string& warning) const;
};

}  // namespace microinjection
