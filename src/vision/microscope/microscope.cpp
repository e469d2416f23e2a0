#include "vision/microscope/microscope.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/errors.h"
#include "vision/microscope/bore_column_layer.h"
#include "vision/microscope/cell_layer.h"
#include "vision/microscope/debris_layer.h"
#include "vision/microscope/pipette_layer.h"

namespace microinjection {
namespace {

const MicroscopeConfig& validated(const MicroscopeConfig& config) {
  config.validate();
  return config;
}

}  // namespace

Microscope::Microscope(const MicroscopeConfig& config) : config_(validated(config)), optics_(config), sensor_(config) {}

cv::Mat Microscope::render(const MicroscopeScene& scene, double focus, std::uint64_t seed) {
  return sensor_.expose(transmission(scene, focus), seed);
}

cv::Mat Microscope::transmission(const MicroscopeScene& scene, double focus) {
  scene.validate();
  if (!std::isfinite(focus)) throw ConfigError("focus is not finite");
  const CameraView& view = config_.camera;
  OpticalImage image;
  image.transmission = cv::Mat(view.height, view.width, CV_32F, cv::Scalar(1));
  if (optics_.contrastMode() == ContrastMode::kDic)
    image.path = cv::Mat(view.height, view.width, CV_32F, cv::Scalar(0));
  for (const CellScene& cell : scene.cells) addCell(cell, focus, view, optics_, texture_, image);
  if (scene.holding) addPipette(*scene.holding, focus, view, optics_, image);
  if (scene.injection) {
    addPipette(*scene.injection, focus, view, optics_, image);
    addBoreColumn(*scene.injection, focus, view, optics_, texture_, image);
  }
  for (const Debris& debris : scene.debris) addDebris(debris, focus, view, optics_, image);
  if (!image.path.empty()) shear(image);
  return image.transmission;
}

/// Two images of the light's phase, a shear apart, interfere: the intensity follows the phase's
/// derivative along the shear.
void Microscope::shear(OpticalImage& image) const {
  const double shear = config_.contrast.shear / config_.camera.pixel_size;  // px
  const auto right = static_cast<float>(0.5 * shear * std::cos(config_.contrast.shear_angle));
  const auto down = static_cast<float>(0.5 * shear * std::sin(config_.contrast.shear_angle));
  const cv::Matx33f derivative(0, -down, 0, -right, 0, right, 0, down, 0);
  cv::Mat change;
  cv::filter2D(image.path, change, CV_32F, derivative, cv::Point(-1, -1), 1, cv::BORDER_REPLICATE);
  cv::max(change, 0, change);
  cv::multiply(image.transmission, change, image.transmission);
}

}  // namespace microinjection
