#include "vision/measurement/vision_config.h"

#include <filesystem>

#include "base/errors.h"
#include "vision/calibration/calibration_file.h"
#include "vision/segmentation/learned_eye.h"

namespace microinjection {

VisionConfig VisionConfig::read(ConfigReader& reader) {
  VisionConfig config;
  reader.path("calibration", config.calibration);
  reader.number("pixel_size", config.pixel_size, Range::closed(0, 1e-4));
  reader.number("image_timeout", config.image_timeout, Range::positive());
  reader.number("serve_timeout", config.serve_timeout, Range::positive());
  reader.boolean("overlay", config.overlay);
  reader.integer("measured_images", config.measured_images, Range::closed(kLeastImages, 1000));
  reader.choice("eyes", config.eyes, {"both", "geometry"});
  config.tracker = SpecimenTrackerConfig::read(reader);
  return config;
}

VisionConfig VisionConfig::load(const std::string& path) {
  ConfigReader reader = ConfigReader::ofFile(path);
  VisionConfig config = read(reader);
  reader.finish();
  return config;
}

VisionConfig VisionConfig::standard() {
  ConfigReader nothing(YAML::Node(YAML::NodeType::Map), "");
  return read(nothing);
}

std::shared_ptr<SecondEye> VisionConfig::secondEye() const {
  return eyes == "both" ? std::make_shared<LearnedEye>() : nullptr;
}

double VisionConfig::pixelSize(const Eigen::Vector2i& image, std::string& warning) const {
  warning.clear();
  if (pixel_size > 0) return pixel_size;
  const std::string path = calibrationPath(calibration);
  if (!std::filesystem::exists(path))
    throw ConfigError("pixel_size = 0: unknown, and there is no calibration " + path +
                      ": calibrate, or set pixel_size");
  const CameraCalibration read = readCalibration(path);
  if (const std::string refusal = read.refusalOf(image); !refusal.empty()) throw ConfigError(path + ": " + refusal);
  if (const std::string doubt = read.warning(); !doubt.empty()) warning = path + ": " + doubt;
  return read.value[kPixelSize];
}

}  // namespace microinjection
