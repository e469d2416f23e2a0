#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "vision/microscope/camera_sensor.h"
#include "vision/microscope/microscope_config.h"
#include "vision/microscope/microscope_scene.h"
#include "vision/microscope/optics.h"
#include "vision/microscope/texture.h"

namespace microinjection {

/// The virtual microscope: pictures of a scene through focus, with known geometry.
///
/// Every border is rendered from its signed distance, by the response of the objective to a straight
/// edge at the border's distance from the plane in focus. The response is odd about the edge, so
/// that a border stays where the scene has it, to a few hundredths of a pixel, in every contrast mode and
/// focus. doc/design/microscope.md has the model and what it leaves out.
///
/// Not for several threads at once: it keeps blurred textures.
class Microscope {
 public:
  /// Throws ConfigError for a bad configuration.
  explicit Microscope(const MicroscopeConfig& config);

  /// Returns the picture, CV_8U or CV_16U, of the camera's size. `focus` (m) is the world's y of the
  /// plane in focus. The same scene, focus and seed give the same picture. Throws ConfigError for a
  /// scene that cannot be rendered (MicroscopeScene::validate).
  cv::Mat render(const MicroscopeScene& scene, double focus, std::uint64_t seed);

  /// The same without the camera: the share of the illumination that reaches each pixel, CV_32F.
  cv::Mat transmission(const MicroscopeScene& scene, double focus);

  const MicroscopeConfig& config() const { return config_; }
  const Optics& optics() const { return optics_; }
  const cv::Mat& illumination() const { return sensor_.illumination(); }  ///< CV_32F, grey levels

 private:
  void shear(OpticalImage& image) const;

  MicroscopeConfig config_;
  Optics optics_;
  CameraSensor sensor_;
  Texture texture_;
};

}  // namespace microinjection
