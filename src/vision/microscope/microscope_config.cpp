#include "vision/microscope/microscope_config.h"

#include <cmath>

#include "base/config_errors.h"

namespace microinjection {
namespace {

const Range kAperture = Range::closed(0.01, 1.5);
const Range kCondenser = Range::closed(0.005, 1.5);
const Range kWavelength = Range::closed(0.2e-6, 2e-6);  // m
const Range kContrast = Range::closed(0, 3);
const Range kShearAngle = Range::closed(-2 * M_PI, 2 * M_PI);  // rad
const Range kShear = Range::closed(0.05e-6, 10e-6);            // m
const Range kHalo = Range::closed(0.5e-6, 50e-6);              // m
const Range kLevel = Range::closed(0, 10);
const Range kGradient = Range::closed(-1, 1);
const Range kVignetting = Range::closed(0, 1);
const Range kFieldStop = Range::closed(0, 2);
const Range kMottle = Range::closed(0, 0.5);
const Range kGain = Range::closed(1e-3, 1e6);
const Range kQuality = Range::closed(0, 100);
constexpr char kBits[] = "8 or 16";
constexpr char kNoJpeg[] = "0 with 16 bits: JPEG has 8";

bool goodBits(int bits) { return bits == 8 || bits == 16; }

}  // namespace

MicroscopeConfig MicroscopeConfig::read(ConfigReader& reader) {
  MicroscopeConfig config;
  ConfigReader camera = reader.section("camera");
  config.camera = CameraView::read(camera);
  ConfigReader objective = reader.section("objective");
  objective.number("numerical_aperture", config.objective.numerical_aperture, kAperture);
  objective.number("condenser_aperture", config.objective.condenser_aperture, kCondenser);
  objective.number("wavelength", config.objective.wavelength, kWavelength);
  ConfigReader contrast = reader.section("contrast");
  readContrastMode(contrast, "mode", config.contrast.mode, false);
  contrast.number("strength", config.contrast.strength, kContrast);
  contrast.number("shear_angle", config.contrast.shear_angle, kShearAngle);
  contrast.number("shear", config.contrast.shear, kShear);
  contrast.number("halo", config.contrast.halo, kHalo);
  ConfigReader illumination = reader.section("illumination");
  illumination.number("level", config.illumination.level, kLevel);
  illumination.vector("gradient", config.illumination.gradient, kGradient);
  illumination.number("vignetting", config.illumination.vignetting, kVignetting);
  illumination.number("field_stop", config.illumination.field_stop, kFieldStop);
  illumination.number("mottle", config.illumination.mottle, kMottle);
  ConfigReader sensor = reader.section("sensor");
  sensor.number("gain", config.sensor.gain, kGain);
  sensor.number("read_noise", config.sensor.read_noise, Range::nonNegative());
  sensor.integer("bits", config.sensor.bits, Range::closed(8, 16));
  sensor.integer("jpeg_quality", config.sensor.jpeg_quality, kQuality);
  if (!goodBits(config.sensor.bits)) sensor.error("bits", std::string("must be ") + kBits);
  if (config.sensor.bits == 16 && config.sensor.jpeg_quality > 0)
    sensor.error("jpeg_quality", std::string("must be ") + kNoJpeg);
  return config;
}

void MicroscopeConfig::validate() const {
  camera.validate();
  ConfigErrors errors("microscope");
  errors.require(kAperture, "numerical_aperture", objective.numerical_aperture);
  errors.require(kCondenser, "condenser_aperture", objective.condenser_aperture);
  errors.require(kWavelength, "wavelength", objective.wavelength, " m");
  if (contrast.mode == ContrastMode::kUnknown) errors.add("mode = unknown: must be one of: bright_field, phase, dic");
  errors.require(kContrast, "strength", contrast.strength);
  errors.require(kShearAngle, "shear_angle", contrast.shear_angle, " rad");
  errors.require(kShear, "shear", contrast.shear, " m");
  errors.require(kHalo, "halo", contrast.halo, " m");
  errors.require(kLevel, "level", illumination.level);
  errors.require(kGradient, "gradient x", illumination.gradient.x());
  errors.require(kGradient, "gradient y", illumination.gradient.y());
  errors.require(kVignetting, "vignetting", illumination.vignetting);
  errors.require(kFieldStop, "field_stop", illumination.field_stop);
  errors.require(kMottle, "mottle", illumination.mottle);
  errors.require(kGain, "gain", sensor.gain, " electrons");
  errors.require(Range::nonNegative(), "read_noise", sensor.read_noise, " electrons");
  errors.require(goodBits(sensor.bits), "bits", sensor.bits, "", kBits);
  errors.require(kQuality, "jpeg_quality", sensor.jpeg_quality);
  errors.require(sensor.bits != 16 || sensor.jpeg_quality == 0, "jpeg_quality", sensor.jpeg_quality, "", kNoJpeg);
  errors.throwAny();
}

}  // namespace microinjection
