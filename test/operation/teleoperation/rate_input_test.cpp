#include "operation/teleoperation/rate_input.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.h"

namespace microinjection {
namespace {

RateInputConfig rateInputConfig() {
  RateInputConfig config;
  config.axes = {1, 0, 3};
  config.deflection = {-0.01, 0.02, 0.03};
  config.dead_man = 1;
  return config;
}

const std::vector<int> kHeld{0, 1}, kLoose{1, 0};

TEST(RateInput, AxesAreChosenScaledAndTurned) {
  RateInput stick(rateInputConfig());
  const auto reading = stick.read({0.5F, 0.25F, 9.0F, -1.0F}, kHeld);
  ASSERT_TRUE(reading);
  EXPECT_TRUE(reading->position.isApprox(Eigen::Vector3d(-0.0025, 0.01, -0.03), 1e-12));
}

TEST(RateInput, TheOperatorIsPresentOnlyOnceTheHeldStickWasLetGo) {
  RateInput stick(rateInputConfig());
  const std::vector<float> centre{0.05F, -0.05F, 0, 0}, deflected{0, 0, 0, 1};
  EXPECT_FALSE(stick.read(centre, kLoose)->operator_present);
  EXPECT_FALSE(stick.read(deflected, kHeld)->operator_present);  // taken up deflected
  EXPECT_TRUE(stick.read(centre, kHeld)->operator_present);
  EXPECT_TRUE(stick.read(deflected, kHeld)->operator_present);
  EXPECT_FALSE(stick.read(deflected, kLoose)->operator_present);
  EXPECT_FALSE(stick.read(deflected, kHeld)->operator_present);
  EXPECT_TRUE(stick.read(centre, kHeld)->operator_present);
  stick.reset();
  EXPECT_FALSE(stick.read(deflected, kHeld)->operator_present);
}

TEST(RateInput, WithoutADeadManTheStickMustStillHaveBeenLetGo) {
  RateInputConfig loose = rateInputConfig();
  loose.dead_man = -1;
  RateInput stick(loose);
  EXPECT_FALSE(stick.read({0, 0, 0, 1}, {})->operator_present);
  EXPECT_TRUE(stick.read({0, 0, 0, 0}, {})->operator_present);
  EXPECT_TRUE(stick.read({0, 0, 0, 1}, {})->operator_present);
}

TEST(RateInput, WhatIsMissingOrNoNumberIsNoReading) {
  RateInput stick(rateInputConfig());
  EXPECT_FALSE(stick.read({0, 0, 0}, kHeld));
  EXPECT_FALSE(stick.read({0, 0, 0, 0}, {0}));
  EXPECT_FALSE(stick.read({0, std::nanf(""), 0, 0}, kHeld));
  EXPECT_FALSE(stick.read({0, 0, 0, 350}, kHeld));           // a space mouse whose full scale is not set
  EXPECT_TRUE(stick.read({0, 0, std::nanf(""), 0}, kHeld));  // an axis that nobody asked for
}

TEST(RateInputConfig, NamesAnAxisThatIsNoNumberOfOne) {
  ConfigReader reader(YAML::Load("axes: [0, 1.5, 2]"), "test");
  RateInputConfig::read(reader);
  try {
    reader.finish();
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("axes"), std::string::npos);
  }
}

}  // namespace
}  // namespace microinjection
