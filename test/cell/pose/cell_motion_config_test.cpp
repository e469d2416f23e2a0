#include "cell/pose/cell_motion_config.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>

#include "base/errors.h"

namespace microinjection {
namespace {

TEST(CellMotionConfig, ReadsItsKeys) {
  ConfigReader reader(YAML::Load("{viscosity: 1e-3, friction: {lip: 0.5, needle: 0}}"), "cell.yaml");
  CellMotionConfig config;
  config.read(reader);
  reader.finish();
  EXPECT_EQ(config.radius, CellMotionConfig().radius);
  EXPECT_EQ(config.friction.lip, 0.5);
  EXPECT_EQ(config.friction.needle, 0);
  EXPECT_EQ(config.friction.dish, CellMotionConfig().friction.dish);
  EXPECT_NEAR(config.drag(), 6 * M_PI * 1e-3 * 40e-6, 1e-18);
}

TEST(CellMotionConfig, RefusesUnknownKeys) {
  ConfigReader reader(YAML::Load("{friction: {lips: 0.5}}"), "cell.yaml");
  CellMotionConfig config;
  config.read(reader);
  EXPECT_THROW(reader.finish(), ConfigError);
}

TEST(CellMotionConfig, SaysAllThatIsWrong) {
  EXPECT_NO_THROW(CellMotionConfig().validate());
  CellMotionConfig config;
  config.viscosity = 0;
  config.friction.dish = -1;
  config.modulus = NAN;
  config.roughness = 1;
  try {
    config.validate();
    FAIL();
  } catch (const ConfigError& error) {
    for (const char* key : {"viscosity", "friction/dish", "modulus", "roughness"}) {
      EXPECT_NE(std::string(error.what()).find(key), std::string::npos) << key;
    }
  }
}

}  // namespace
}  // namespace microinjection
