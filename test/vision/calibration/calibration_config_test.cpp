#include "vision/calibration/calibration_config.h"

#include <gtest/gtest.h>

#include <string>

#include "base/errors.h"

namespace microinjection {
namespace {

CalibrationConfig fromText(const std::string& text) {
  ConfigReader reader(YAML::Load(text), "test");
  const CalibrationConfig config = CalibrationConfig::read(reader);
  reader.finish();
  return config;
}

TEST(CalibrationConfig, TheFileHasTheDefaults) {
  const std::string path = std::string(MICROINJECTION_SOURCE_DIR) + "/config/calibration.yaml";
  YAML::Node yaml = loadYamlMap(path);
  for (const char* key : {"file", "input_timeout"}) yaml.remove(key);  // of the node
  ConfigReader reader(yaml, path);
  const CalibrationConfig file = CalibrationConfig::read(reader), code;
  reader.finish();
  EXPECT_EQ(file.pattern.field, code.pattern.field);
  EXPECT_EQ(file.pattern.columns, code.pattern.columns);
  EXPECT_EQ(file.pattern.take_up, code.pattern.take_up);
  EXPECT_EQ(file.pattern.duration_limit, code.pattern.duration_limit);
  EXPECT_EQ(file.limits.mirror, code.limits.mirror);
  EXPECT_EQ(file.limits.pixel_size, code.limits.pixel_size);
  EXPECT_EQ(file.limits.focus_interval, code.limits.focus_interval);
  EXPECT_EQ(file.drift.threshold, code.drift.threshold);
  EXPECT_EQ(file.drift.confidence, code.drift.confidence);
  EXPECT_EQ(file.touch.least_change, code.touch.least_change);
  EXPECT_EQ(file.focus.second_peak, code.focus.second_peak);
  EXPECT_NO_THROW(file.pattern.validate());
  EXPECT_NO_THROW(file.limits.validate());
}

TEST(CalibrationConfig, RefusesUnknownKeysAndBadValues) {
  for (const char* text : {"{patern: {}}", "{limits: {mirror: maybe}}", "{limits: {largest_backlash: -1}}",
                           "{limits: {pixel_size: [2, 1]}}", "{drift: {window: 1}}", "{touch: {false_rate: 0}}",
                           "{focus: {least_contrast: 2}}", "{pattern: {depth: 1e-6}}", "{pattern: {speed: .nan}}"}) {
    EXPECT_THROW(fromText(text), ConfigError) << text;
  }
  EXPECT_NO_THROW(fromText("{}"));
}

TEST(CalibrationConfig, TheTakeUpMustBeAboveTheLargestBacklash) {
  EXPECT_THROW(fromText("{limits: {largest_backlash: 8e-6}}"), ConfigError);
}

TEST(CalibrationLimits, ValidateReportsAllErrorsAtOnce) {
  CalibrationLimits limits;
  limits.mirror = "maybe";
  limits.least_points = 1;
  limits.largest_residual = 0;
  try {
    limits.validate();
    FAIL();
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("mirror = maybe"), std::string::npos);
    EXPECT_NE(text.find("least_points = 1"), std::string::npos);
    EXPECT_NE(text.find("largest_residual = 0"), std::string::npos);
  }
}

}  // namespace
}  // namespace microinjection
