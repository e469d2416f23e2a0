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

std::optional<RateInput::Reading> read(RateInput& stick, const std::vector<float>& axes,
                                       const std::vector<int>& buttons, double time = 0) {
  return stick.read(axes, buttons, time);
}

TEST(RateInput, AxesAreChosenScaledAndTurned) {
  RateInput stick(rateInputConfig());
  const auto reading = read(stick, {0.5F, 0.25F, 9.0F, -1.0F}, kHeld);
  ASSERT_TRUE(reading);
  EXPECT_TRUE(reading->position.isApprox(Eigen::Vector3d(-0.0025, 0.01, -0.03), 1e-12));
}

TEST(RateInput, TheOperatorIsPresentOnlyOnceTheHeldStickWasLetGo) {
  RateInput stick(rateInputConfig());
  const std::vector<float> centre{0.05F, -0.05F, 0, 0}, deflected{0, 0, 0, 1};
  EXPECT_FALSE(read(stick, centre, kLoose)->operator_present);
  EXPECT_FALSE(read(stick, deflected, kHeld)->operator_present);  // taken up deflected
  EXPECT_TRUE(read(stick, centre, kHeld)->operator_present);
  EXPECT_TRUE(read(stick, deflected, kHeld)->operator_present);
  EXPECT_FALSE(read(stick, deflected, kLoose)->operator_present);
  EXPECT_FALSE(read(stick, deflected, kHeld)->operator_present);
  EXPECT_TRUE(read(stick, centre, kHeld)->operator_present);
  stick.reset();
  EXPECT_FALSE(read(stick, deflected, kHeld)->operator_present);
}

TEST(RateInput, WithoutADeadManTheStickMustStillHaveBeenLetGo) {
  RateInputConfig loose = rateInputConfig();
  loose.dead_man = -1;
  RateInput stick(loose);
  EXPECT_FALSE(read(stick, {0, 0, 0, 1}, {})->operator_present);
  EXPECT_TRUE(read(stick, {0, 0, 0, 0}, {})->operator_present);
  EXPECT_TRUE(read(stick, {0, 0, 0, 1}, {})->operator_present);
}

/// Of 15 um/s of the needle at full deflection: 22 um.
TEST(RateInput, AnUnchangedDeflectionCountsForAWhile) {
  for (const float deflection : {1.0F, 0.5F}) {
    RateInput stick(rateInputConfig());
    ASSERT_TRUE(read(stick, {0, 0, 0, 0}, kHeld, 0)->operator_present);
    double until = 0;
    for (double t = 0.01; t < 10; t += 0.01) {
      const auto reading = read(stick, {0, 0, 0, deflection}, kHeld, t);
      if (reading && reading->operator_present) until = t;
    }
    EXPECT_NEAR(until, 1.5 / deflection, 0.03);
    EXPECT_TRUE(stick.repeats());
    // It is renewed, but must have been let go.
    EXPECT_FALSE(read(stick, {0, 0, 0, 0.9F * deflection}, kHeld, 10)->operator_present);
    EXPECT_TRUE(read(stick, {0, 0, 0, 0}, kHeld, 10.1)->operator_present);
    EXPECT_TRUE(read(stick, {0, 0, 0, deflection}, kHeld, 10.2)->operator_present);
  }
}

TEST(RateInput, AHandThatTremblesMayHoldADeflectionForLong) {
  RateInput stick(rateInputConfig());
  read(stick, {0, 0, 0, 0}, kHeld, 0);
  for (double t = 0.01; t < 20; t += 0.01) {
    const float tremor = static_cast<int>(t * 100) % 30 < 15 ? 0.99F : 1.0F;
    ASSERT_TRUE(read(stick, {0, 0, 0, tremor}, kHeld, t)->operator_present) << t;
  }
}

TEST(RateInput, ADeviceThatRestsOffItsZeroDoesNotCreep) {
  RateInputConfig config = rateInputConfig();
  config.dead_man = -1;
  RateInput stick(config);
  const std::vector<float> rest{0.2F, 0, 0, -0.15F};
  for (double t = 0; t < 1.5; t += 0.01) read(stick, rest, {}, t);
  EXPECT_TRUE(read(stick, rest, {}, 2)->position.isZero());
  EXPECT_TRUE(read(stick, rest, {}, 2)->operator_present);
  EXPECT_NEAR(read(stick, {0.2F, 0, 0, 0.35F}, {}, 3)->position.z(), 0.5 * 0.03, 1e-6);
  EXPECT_TRUE(read(stick, {0.02F, 0, 0, 0.01F}, {}, 4)->position.isZero()) << "back at its true zero";
}

TEST(RateInput, WhatIsMissingOrNoNumberIsNoReading) {
  RateInput stick(rateInputConfig());
  EXPECT_FALSE(read(stick, {0, 0, 0}, kHeld));
  EXPECT_FALSE(read(stick, {0, 0, 0, 0}, {0}));
  EXPECT_FALSE(read(stick, {0, std::nanf(""), 0, 0}, kHeld));
  EXPECT_FALSE(read(stick, {0, 0, 0, 350}, kHeld));           // a space mouse whose full scale is not set
  EXPECT_TRUE(read(stick, {0, 0, std::nanf(""), 0}, kHeld));  // an axis that nobody asked for
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
