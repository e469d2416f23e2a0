#include "operation/teleoperation/force_source.h"

#include <gtest/gtest.h>

#include <limits>

namespace microinjection {
namespace {

const Eigen::Vector3d kPredicted(0, 0, 1e-6), kMeasured(0, 0, 3e-6);
const Eigen::Vector3d kNan = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());

ForceSourceConfig source(const std::string& name) {
  ForceSourceConfig config;
  config.source = name;
  config.measured_share = 0.25;
  return config;
}

TEST(ForceSource, TakesWhatIsConfigured) {
  EXPECT_EQ(*chooseForce(source("predicted"), {kPredicted, kMeasured}), kPredicted);
  EXPECT_EQ(*chooseForce(source("measured"), {kPredicted, kMeasured}), kMeasured);
  EXPECT_LT((*chooseForce(source("blend"), {kPredicted, kMeasured}) - Eigen::Vector3d(0, 0, 1.5e-6)).norm(), 1e-20);
}

TEST(ForceSource, WithoutASourceThatItNeedsThereIsNoForce) {
  EXPECT_FALSE(chooseForce(source("predicted"), {std::nullopt, kMeasured}));
  EXPECT_FALSE(chooseForce(source("predicted"), {kNan, kMeasured}));
  EXPECT_FALSE(chooseForce(source("measured"), {kPredicted, std::nullopt}));
  EXPECT_FALSE(chooseForce(source("measured"), {kPredicted, kNan}));
  EXPECT_FALSE(chooseForce(source("blend"), {std::nullopt, kMeasured}));
  EXPECT_FALSE(chooseForce(source("blend"), {kPredicted, std::nullopt}));
  EXPECT_FALSE(chooseForce(source("blend"), {kPredicted, kNan}));
}

TEST(ForceSource, DoesNotNeedWhatItDoesNotUse) {
  EXPECT_TRUE(chooseForce(source("predicted"), {kPredicted, std::nullopt}));
  EXPECT_TRUE(chooseForce(source("measured"), {kNan, kMeasured}));
}

}  // namespace
}  // namespace microinjection
