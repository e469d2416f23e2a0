#include "vision/calibration/image_approach.h"

#include <gtest/gtest.h>

#include <cmath>

#include "benchmark/common/simulated_needle.h"

namespace microinjection {
namespace {

constexpr double kControlPeriod = 0.01;  // s

/// A needle that follows set-points at once, and a camera with 25 images a second.
class ImageApproachTest : public testing::Test {
 protected:
  ImageApproachTest() : truth_(drawnNeedle(7)), needle_(truth_, start_) {
    calibration_.mirrored = truth_.mirrored;
    calibration_.value = truth_.value;
    calibration_.origin = truth_.origin;
    calibration_.estimated.fill(true);
  }

  ImageApproach approach(const Eigen::Vector2d& pixel) const { return {config_, calibration_, pixel, start_, 0}; }

  void run(ImageApproach& approach, double duration = 100) {
    Eigen::Vector3d position = start_;
    std::optional<SeenTip> tip;
    double rested = 0;
    for (double now = 0; now < duration && !approach.done() && approach.failure().empty(); now += kControlPeriod) {
      const auto setpoint = approach.step({now, position, rested, tip});
      if (setpoint && follows_ && *setpoint != position) {
        largest_step_ = std::max(largest_step_, (*setpoint - position).norm());
        lowest_ = std::min(lowest_, setpoint->z());
        position = *setpoint;
        needle_.moveTo(position);
        rested = now;
      }
      if (std::fmod(now, 0.04) < kControlPeriod && sees_)
        tip = SeenTip{now, needle_.seenPixel() + wrong_, 0.04 * Eigen::Matrix2d::Identity()};
    }
  }

  ImageApproachConfig config_;
  Eigen::Vector3d start_{0, 0, 60e-6};
  SimulatedNeedleConfig truth_;
  SimulatedNeedle needle_;
  CameraCalibration calibration_;
  Eigen::Vector2d wrong_{0, 0};  ///< px
  bool follows_ = true, sees_ = true;
  double largest_step_ = 0, lowest_ = 1;
};

TEST_F(ImageApproachTest, ItsFileHasTheDefaults) {
  const std::string path = std::string(MICROINJECTION_SOURCE_DIR) + "/config/visual_servo.yaml";
  YAML::Node yaml = loadYamlMap(path);
  for (const char* key : {"calibration", "input_timeout"}) yaml.remove(key);  // of the node
  ConfigReader reader(yaml, path);
  const ImageApproachConfig file = ImageApproachConfig::read(reader), code;
  reader.finish();
  EXPECT_EQ(file.speed, code.speed);
  EXPECT_EQ(file.time_limit, code.time_limit);
  EXPECT_EQ(file.target.gain, code.target.gain);
  EXPECT_EQ(file.target.largest_jump, code.target.largest_jump);
}

TEST_F(ImageApproachTest, BringsTheTipToThePixel) {
  const Eigen::Vector2d target = needle_.truePixel() + Eigen::Vector2d(120, -80);
  ImageApproach approach = this->approach(target);
  run(approach);
  ASSERT_TRUE(approach.done()) << approach.failure() << approach.waitsFor();
  EXPECT_LT((needle_.truePixel() - target).norm(), 2);
  EXPECT_LE(largest_step_, config_.speed * kControlPeriod * (1 + 1e-9));  // a stream without jumps
}

TEST_F(ImageApproachTest, WaitsForANeedleThatDoesNotFollow) {
  ImageApproach approach = this->approach({100, 100});
  follows_ = false;
  run(approach);
  EXPECT_NE(approach.failure().find("does not follow"), std::string::npos) << approach.failure();
}

TEST_F(ImageApproachTest, HoldsWithoutATip) {
  ImageApproach approach = this->approach({100, 100});
  sees_ = false;
  run(approach);
  EXPECT_NE(approach.failure().find("not seen"), std::string::npos) << approach.failure();
  EXPECT_EQ(lowest_, 60e-6 + config_.speed * kControlPeriod);  // it has moved away from the cell only
}

TEST_F(ImageApproachTest, DoesNotFollowSomethingElse) {
  ImageApproach approach = this->approach(needle_.truePixel());
  wrong_ = {600, 0};  // px
  run(approach);
  EXPECT_NE(approach.failure().find("from where it is expected"), std::string::npos) << approach.failure();
}

TEST_F(ImageApproachTest, HoldsWithoutAPosition) {
  ImageApproach approach = this->approach(needle_.truePixel());
  Eigen::Vector3d position = start_;
  for (double now = 0; now < 0.2; now += kControlPeriod)
    position = approach.step({now, position, 0, std::nullopt}).value();
  EXPECT_NE(position, start_);  // it is under way
  for (double now = 0.2; now < 1; now += kControlPeriod)
    EXPECT_EQ(approach.step({now, std::nullopt, 0, std::nullopt}).value(), position);
  EXPECT_NE(approach.waitsFor().find("position"), std::string::npos);
}

TEST_F(ImageApproachTest, AStallIsNoJump) {
  ImageApproach approach = this->approach(needle_.truePixel());
  const Eigen::Vector3d before = approach.step({0, start_, 0, std::nullopt}).value();
  approach.step({1, before, 0, std::nullopt});
  const Eigen::Vector3d begun = approach.step({1.01, before, 0, std::nullopt}).value();
  const Eigen::Vector3d after = approach.step({11, begun, 0, std::nullopt}).value();
  EXPECT_LE((after - begun).norm(), 0.05 * config_.speed * (1 + 1e-9));
}

}  // namespace
}  // namespace microinjection
