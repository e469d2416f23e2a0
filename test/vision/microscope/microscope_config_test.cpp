#include "vision/microscope/microscope_config.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/errors.h"

namespace microinjection {
namespace {

std::string errorOf(const std::string& yaml) {
  try {
    ConfigReader reader(YAML::Load(yaml), "test");
    MicroscopeConfig::read(reader);
    reader.finish();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(MicroscopeConfig, ItsFileHasTheDefaults) {
  const std::string path = std::string(MICROINJECTION_SOURCE_DIR) + "/config/microscope.yaml";
  YAML::Node file = loadYamlMap(path);
  for (const char* key : {"rate", "needle", "state_timeout", "focus", "specimen"}) file.remove(key);  // of the node
  ConfigReader reader(file, path);
  const MicroscopeConfig config = MicroscopeConfig::read(reader), built_in;
  reader.finish();
  config.validate();
  EXPECT_EQ(config.camera.pixel_size, built_in.camera.pixel_size);
  EXPECT_EQ(config.camera.origin, built_in.camera.origin);
  EXPECT_EQ(config.objective.condenser_aperture, built_in.objective.condenser_aperture);
  EXPECT_EQ(config.contrast.mode, built_in.contrast.mode);
  EXPECT_EQ(config.contrast.shear, built_in.contrast.shear);
  EXPECT_EQ(config.illumination.gradient, built_in.illumination.gradient);
  EXPECT_EQ(config.illumination.mottle, built_in.illumination.mottle);
  EXPECT_EQ(config.sensor.gain, built_in.sensor.gain);
  EXPECT_EQ(config.sensor.bits, built_in.sensor.bits);
}

TEST(MicroscopeConfig, RefusesBadKeysAndValues) {
  EXPECT_EQ(errorOf("{contrast: {mode: dic}, sensor: {bits: 16}}"), "");
  EXPECT_NE(errorOf("{zoom: 2}").find("zoom"), std::string::npos);
  EXPECT_NE(errorOf("{objective: {aperture: 0.4}}").find("objective/aperture"), std::string::npos);
  EXPECT_NE(errorOf("{objective: {numerical_aperture: 0}}").find("numerical_aperture = 0"), std::string::npos);
  EXPECT_NE(errorOf("{contrast: {mode: dark_field}}").find("mode = dark_field"), std::string::npos);
  EXPECT_NE(errorOf("{sensor: {bits: 12}}").find("8 or 16"), std::string::npos);
  EXPECT_NE(errorOf("{sensor: {bits: 16, jpeg_quality: 90}}").find("jpeg_quality"), std::string::npos);
  EXPECT_NE(errorOf("{sensor: {gain: 0}}").find("gain = 0"), std::string::npos);
  EXPECT_NE(errorOf("{illumination: {gradient: [1]}}").find("gradient"), std::string::npos);
  EXPECT_NE(errorOf("{camera: {pixel_size: -1}}").find("pixel_size"), std::string::npos);
}

TEST(MicroscopeConfig, ReportsAllErrorsAtOnce) {
  MicroscopeConfig config;
  config.objective.wavelength = NAN;
  config.contrast.mode = ContrastMode::kUnknown;
  config.sensor.bits = 10;
  try {
    config.validate();
    FAIL();
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    for (const char* part : {"wavelength = nan", "mode = unknown", "bits = 10"})
      EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace microinjection
