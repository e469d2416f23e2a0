#include <actionlib_msgs/GoalStatus.h>
#include <gtest/gtest.h>
#include <std_srvs/Trigger.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "action_client.h"
#include "cell_microinjection/CalibrateAction.h"
#include "controlled_needle.h"
#include "placed_specimen.h"
#include "vision/calibration/calibration_file.h"

namespace microinjection {
namespace {

/// The camera is calibrated on a simulated rig with backlash, which must be found in images.
class CalibrationTest : public testing::Test {
 protected:
  static constexpr double kBacklash = 2e-6, kFieldX = 60e-6, kFieldZ = 45e-6, kWide = 800e-6;  // m
  using Goal = cell_microinjection::CalibrateGoal;

  CalibrationTest() {
    session_.add("micromanipulator", "{device: {backlash: 2.0e-6}}");
    session_.add("cell_simulator");
    session_.add("injection_controller");
    session_.add("vision");
    session_.add("calibration", "{file: " + file_ + ", pattern: {columns: 4, rows: 4, duration_limit: 300}}");
    session_.add("microscope", camera_.parameters(5));
    session_.run(0.5);
    EXPECT_EQ(needle_.controller(), "DISABLED");
  }

  void send(double field_x, double field_z = kFieldZ) {
    Goal goal;
    goal.field_x = field_x;
    goal.field_z = field_z;
    action_.send(goal);
    session_.run(0.05);
  }
  cell_microinjection::CalibrateResult result(double limit = 1) {
    EXPECT_TRUE(session_.until([&] { return action_.ended(); }, limit));
    return action_.ended() ? *action_.result() : cell_microinjection::CalibrateResult();
  }
  std_srvs::TriggerResponse ask(const std::string& service) {
    return session_.call<std_srvs::Trigger>("/calibration/" + service);
  }
  std::string text() const {
    std::ifstream file(file_);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// A wide pattern, whose first point is 4 s away, once the needle is on the way there.
  void setOff() {
    const double start = needle_.place().x();
    send(kWide);
    ASSERT_FALSE(action_.ended()) << action_.result()->message;
    ASSERT_TRUE(session_.until([&] { return std::abs(needle_.place().x() - start) > 3e-6; }, 5));
  }

  // x from -55 to 55 um, z from -30 to 130 um
  SmallCamera camera_{440, 640, {219.5, 519.5}};
  VirtualSession session_{{"camera.source:=sim", "hand.device:=none", "injection.mode:=manual",
                           "injection.auto_enable:=false", "sensor.source:=none", "injector:=none"}};
  std::string file_ = session_.folder() / "calibrated.yaml";
  ControlledNeedle needle_{session_};
  ActionClient<cell_microinjection::CalibrateAction> action_{session_.world(), "/calibration/calibrate"};
};

TEST_F(CalibrationTest, FindsScaleAngleAndBacklash) {
  const double start = needle_.place().z();
  needle_.poses().clear();
  send(kFieldX);
  const auto found = result(120);
  ASSERT_TRUE(found.success) << found.message;
  EXPECT_GE(needle_.lowest(), start - 1e-8);  // never below where it began
  EXPECT_NEAR(found.pixel_size / camera_.pixel, 1, 1e-3);
  EXPECT_LT(found.pixel_size_interval, 2e-3 * camera_.pixel);
  EXPECT_NEAR(found.angle, 0, 0.1 * M_PI / 180);
  EXPECT_FALSE(found.mirrored);
  EXPECT_NEAR(found.backlash[0], kBacklash, 0.3e-6);
  EXPECT_NEAR(found.backlash[2], kBacklash, 0.3e-6);
  const std::string calibrated = text();
  EXPECT_NEAR(YAML::Load(calibrated)["parameters"]["pixel_size"]["value"].as<double>(), found.pixel_size, 1e-12);
  // What was replaced comes back, and again.
  EXPECT_FALSE(ask("undo").success);  // it has replaced none
  session_.run(1);
  const auto rezeroed = ask("rezero");
  EXPECT_TRUE(rezeroed.success) << rezeroed.message;
  const std::string after_rezero = text();
  EXPECT_NE(after_rezero, calibrated);
  for (const std::string& expected : {calibrated, after_rezero, calibrated}) {
    const auto undone = ask("undo");
    EXPECT_TRUE(undone.success) << undone.message;
    EXPECT_EQ(text(), expected);
  }
}

TEST_F(CalibrationTest, RefusesWhileTheControllerMayCommand) {
  needle_.enable();
  send(kFieldX);
  EXPECT_FALSE(result().success);
  EXPECT_NE(result().message.find("must be DISABLED"), std::string::npos) << result().message;
}

TEST_F(CalibrationTest, RefusesAFieldThatIsTooSmallOrNotFinite) {
  const std::pair<double, const char*> cases[] = {
      {1e-6, "field"}, {-60e-6, "field"}, {NAN, "field"}, {0.5, "duration"}};
  for (const auto& [field, reason] : cases) {
    send(field);
    EXPECT_FALSE(result().success) << field;
    EXPECT_NE(result().message.find(reason), std::string::npos) << field << ": " << result().message;
  }
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(CalibrationTest, StopsWhenItIsCancelled) {
  setOff();
  const double start = needle_.place().x();
  action_.cancel();
  EXPECT_EQ(result().message, "cancelled");
  EXPECT_EQ(action_.state(), actionlib_msgs::GoalStatus::PREEMPTED);
  needle_.expectRests(0.3);
  EXPECT_LT(std::abs(needle_.place().x() - start), 20e-6);  // its way in 0.2 s; the point was 400 um away
}

TEST_F(CalibrationTest, ImagesOfAnotherSizeEndIt) {
  setOff();
  cropImages(session_);
  EXPECT_NE(result().message.find("px now, and were of 440 x 640 px"), std::string::npos) << result().message;
  EXPECT_EQ(action_.state(), actionlib_msgs::GoalStatus::ABORTED);
  needle_.expectRests(0.3);
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(CalibrationTest, ThatOfOtherImagesIsNotMadeRightByTheTip) {
  writeCalibration(file_, camera_.calibrationOfOthers(kBacklash));
  const std::string before = text(), reason = "is of images of 880 x 1280 px, this one has 440 x 640 px";
  session_.executive().restart("calibration");
  session_.run(1.5);
  const auto refused = ask("rezero");
  EXPECT_FALSE(refused.success);
  EXPECT_NE(refused.message.find(reason), std::string::npos) << refused.message;
  EXPECT_EQ(text(), before);
  EXPECT_TRUE(session_.diagnostics().ever("calibration: calibration", reason))
      << session_.diagnostics().text("calibration: calibration");
}

TEST_F(CalibrationTest, AnotherCommandEndsIt) {
  setOff();
  session_.world().command("/needle/state_command", "stop");
  EXPECT_NE(result().message.find("command stop"), std::string::npos) << result().message;
  EXPECT_EQ(action_.state(), actionlib_msgs::GoalStatus::ABORTED);
  needle_.expectRests(0.3);
}

}  // namespace
}  // namespace microinjection
