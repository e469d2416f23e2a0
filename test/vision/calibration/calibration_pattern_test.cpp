#include "vision/calibration/calibration_pattern.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/errors.h"
#include "vision/calibration/calibration_trial.h"
#include "vision/calibration/play.h"

namespace microinjection {
namespace {

CalibrationPlan plan(const CalibrationPatternConfig& config, const TravelBox& box = kTestBox) {
  return planCalibration(config, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), box);
}

TEST(CalibrationPattern, StaysInsideAndCountsWhatItObserves) {
  for (const double depth : {0.0, 20e-6}) {
    CalibrationPatternConfig config;
    config.depth = depth;
    const CalibrationPlan result = plan(config);
    ASSERT_TRUE(result.refusals.empty()) << result.refusals.front();
    EXPECT_EQ(result.observations, depth > 0 ? 66 : 60);
    EXPECT_EQ(result.focus_readings, depth > 0 ? 10 : 0);
    EXPECT_LT(result.duration, 60);
    for (const CalibrationWaypoint& each : result.waypoints) {
      EXPECT_TRUE((each.position.array() >= kTestBox.low.array()).all());
      EXPECT_TRUE((each.position.array() <= kTestBox.high.array()).all());
    }
  }
}

TEST(CalibrationPattern, DurationIsMovesAndStops) {
  CalibrationPatternConfig config;
  config.columns = config.rows = 2;
  config.field = {20e-6, 30e-6};
  config.take_up = 10e-6;
  const CalibrationPlan result = plan(config);
  // Way: start to (-20, -25) um, to the corner, 2 rows with a step between, overshoot and back, the same way back.
  const double way = std::hypot(20, 25) + std::hypot(10, 10) + 2 * (20 + 30 + 20) + 2 * std::hypot(10, 10);
  EXPECT_NEAR(result.duration, way / 100 + 10 * 0.1 + 8 * 0.2, 1e-9);
}

TEST(CalibrationPattern, SeesEachPointWithBothDirectionsOfBothAxes) {
  for (const int rows : {4, 5}) {
    CalibrationPatternConfig config;
    config.rows = rows;
    const double backlash = 5e-6;
    Play play(Eigen::Vector3d(backlash, 0, backlash), Eigen::Vector3d::Zero());
    std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> seen;  // place of the motors, of the tip
    for (const CalibrationWaypoint& each : plan(config).waypoints) {
      play.moveTo(each.position);
      if (!each.observe) continue;
      EXPECT_TRUE(play.known());
      seen.emplace_back(each.position, play.tip() - each.position);
    }
    ASSERT_EQ(seen.size(), static_cast<std::size_t>(10 * rows));
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const auto& back = seen[seen.size() - 1 - i];
      EXPECT_EQ(seen[i].first, back.first);
      if (i % 5 == 0 || i % 5 == 4) continue;  // the turns of a row keep the side of its neighbour
      EXPECT_NEAR(seen[i].second.x(), -back.second.x(), 1e-12);
      const bool last_row = i / 5 == static_cast<std::size_t>(rows) - 1 || i / 5 == static_cast<std::size_t>(rows);
      if (!last_row) EXPECT_NEAR(seen[i].second.z(), -back.second.z(), 1e-12) << i;
    }
  }
}

TEST(CalibrationPattern, RefusesABoxThatIsTooSmallAndNamesTheAxis) {
  TravelBox box = kTestBox;
  box.high.z() = 40e-6;
  const CalibrationPlan result = plan({}, box);
  EXPECT_TRUE(result.waypoints.empty());
  ASSERT_EQ(result.refusals.size(), 1u);
  EXPECT_EQ(result.refusals[0], "highest z of the pattern = 5.8e-05 m: must be in [-0.0002, 4e-05] m");
}

TEST(CalibrationPattern, RefusesASessionThatIsTooLong) {
  CalibrationPatternConfig config;
  config.speed = 10e-6;
  const CalibrationPlan result = plan(config);
  ASSERT_EQ(result.refusals.size(), 1u);
  EXPECT_NE(result.refusals[0].find("duration = "), std::string::npos);
}

TEST(CalibrationPattern, ConfigurationRefusesPointsCloserThanTheTakeUp) {
  ConfigReader reader(YAML::Load("{columns: 50}"), "test");
  CalibrationPatternConfig config = CalibrationPatternConfig::read(reader);
  EXPECT_THROW(reader.finish(), ConfigError);
  EXPECT_THROW(config.validate(), ConfigError);
  EXPECT_NO_THROW(CalibrationPatternConfig().validate());
}

}  // namespace
}  // namespace microinjection
