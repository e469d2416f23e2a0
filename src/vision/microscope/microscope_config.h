#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"
#include "vision/camera/camera_view.h"
#include "vision/frame/contrast_mode.h"

namespace microinjection {

struct ObjectiveConfig {
  double numerical_aperture = 0.4;   ///< of the objective: 0.21 wavelength / aperture is the blur in focus (m, rms)
  double condenser_aperture = 0.16;  ///< of the light: half of it is the blur (rms) per defocus
  double wavelength = 0.55e-6;       ///< m
};

struct ContrastConfig {
  ContrastMode mode = ContrastMode::kBrightField;  ///< kUnknown is not valid
  double strength = 1;                             ///< of everything in the scene, over that of its optics
  double shear_angle = 0.8;  ///< rad, dic: direction of the shear in the image, from x towards y (down)
  double shear = 0.6e-6;     ///< m, dic: distance of the sheared images
  double halo = 4.0e-6;      ///< m, phase: rms width of the halo
};

struct IlluminationConfig {
  double level = 0.55;                   ///< of full scale, in the middle of the image; above 1 is over-exposed
  Eigen::Vector2d gradient{0.06, 0.04};  ///< relative change across the image, along its x and its y
  double vignetting = 0.08;              ///< relative loss at the corners
  double field_stop = 0;                 ///< radius of the lit field over half the image's diagonal; 0: none
  double mottle = 0.004;                 ///< relative rms of a coarse fixed pattern
};

struct SensorConfig {
  double gain = 40;       ///< electrons per grey level: the variance of a level's shot noise is level / gain
  double read_noise = 8;  ///< electrons, rms
  int bits = 8;           ///< 8 or 16
  int jpeg_quality = 0;   ///< 1 to 100; 0: not compressed; with 8 bit only
};

/// The virtual microscope and its camera: config/microscope.yaml.
struct MicroscopeConfig {
  CameraView camera;
  ObjectiveConfig objective;
  ContrastConfig contrast;
  IlluminationConfig illumination;
  SensorConfig sensor;

  static MicroscopeConfig read(ConfigReader& reader);
  /// Throws ConfigError with all errors of the members.
  void validate() const;
};

}  // namespace microinjection
