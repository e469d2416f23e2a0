#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>

#include "action_client.h"
#include "cell_microinjection/GoToPixelAction.h"
#include "controlled_needle.h"
#include "placed_specimen.h"
#include "vision/calibration/calibration_file.h"

namespace microinjection {
namespace {

/// The tip is brought to a pixel, on a simulated rig with backlash.
class VisualServoTest : public testing::Test {
 protected:
  static constexpr double kBacklash = 2e-6;  // m
  // 14 um to the left of the needle and 20 um above it
  static constexpr double kX = 164, kY = 200;  // px

  VisualServoTest() {
    writeCalibration(file_, camera_.calibration(kBacklash));
    session_.add("micromanipulator", "{device: {backlash: 2.0e-6}}");
    session_.add("cell_simulator");
    session_.add("injection_controller");
    session_.add("vision");
    session_.add("visual_servo", "{calibration: " + file_ + "}");
    session_.add("microscope", camera_.parameters(10));
    session_.world().hear<geometry_msgs::PointStamped>("/visual_servo/proposed_point");
    session_.world().hear<cell_microinjection::VisionState>("/vision/state");
    session_.run(0.5);
  }

  cell_microinjection::GoToPixelResult go() {
    cell_microinjection::GoToPixelGoal goal;
    goal.x = kX;
    goal.y = kY;
    action_.send(goal);
    EXPECT_TRUE(session_.until([&] { return action_.ended(); }, 30));
    return action_.ended() ? *action_.result() : cell_microinjection::GoToPixelResult();
  }
  /// Says that the tip is wanted at a pixel. @returns the answer
  geometry_msgs::PointStamped propose(const ros::Time& stamp) {
    geometry_msgs::PointStamped pixel;
    pixel.header.stamp = stamp;
    pixel.point.x = kX;
    pixel.point.y = kY;
    session_.world().say("/visual_servo/proposed_pixel", pixel);
    session_.run(0.3);
    const auto* point = session_.world().hear<geometry_msgs::PointStamped>("/visual_servo/proposed_point").newest();
    EXPECT_TRUE(point);
    return point ? *point : geometry_msgs::PointStamped();
  }

  SmallCamera camera_{440, 640, {219.5, 519.5}};
  VirtualSession session_{{"camera.source:=sim", "hand.device:=none", "injection.mode:=manual",
                           "injection.auto_enable:=false", "sensor.source:=none", "injector:=none"}};
  std::string file_ = session_.folder() / "calibrated.yaml";
  ControlledNeedle needle_{session_};
  ActionClient<cell_microinjection::GoToPixelAction> action_{session_.world(), "/visual_servo/go_to_pixel"};
};

TEST_F(VisualServoTest, BringsTheTipToAPixel) {
  needle_.enable();
  const geometry_msgs::PointStamped proposed = propose(session_.now());
  EXPECT_FALSE(proposed.header.stamp.isZero());
  EXPECT_EQ(proposed.header.frame_id, "world");
  EXPECT_TRUE(propose(ros::Time()).header.stamp.isZero());  // it is taken back
  const auto result = go();
  ASSERT_TRUE(result.success) << result.message;
  EXPECT_LT(result.distance, 1);
  session_.run(0.3);
  const auto* state = session_.world().hear<cell_microinjection::VisionState>("/vision/state").newest();
  ASSERT_TRUE(tipIsFound(state));
  EXPECT_LT((seenTip(*state) - Eigen::Vector2d(kX, kY)).norm(), 2);
  // The motors stand beside the tip by the backlash, at most.
  EXPECT_LT((toVector(proposed.point) - needle_.place()).norm(), 1.5 * kBacklash);
}

TEST_F(VisualServoTest, RefusesADisabledController) {
  const Eigen::Vector3d start = needle_.place();
  const auto result = go();
  EXPECT_FALSE(result.success);
  EXPECT_NE(result.message.find("must be ENABLED"), std::string::npos) << result.message;
  EXPECT_LT((needle_.place() - start).norm(), 1e-9);
}

TEST_F(VisualServoTest, RefusesTheCalibrationOfOtherImages) {
  writeCalibration(file_, camera_.calibrationOfOthers(kBacklash));
  needle_.enable();
  const Eigen::Vector3d start = needle_.place();
  const auto result = go();
  EXPECT_FALSE(result.success);
  EXPECT_NE(result.message.find("is of images of 880 x 1280 px, this one has 440 x 640 px"), std::string::npos)
      << result.message;
  EXPECT_LT((needle_.place() - start).norm(), 1e-9);
}

/// It is the place of the tip at that time.
TEST_F(VisualServoTest, AnOldImageIsNotUsed) {
  needle_.enable();
  auto& states = session_.world().hear<cell_microinjection::VisionState>("/vision/state");
  ASSERT_TRUE(tipIsFound(states.newest()));
  cell_microinjection::VisionState last = *states.newest();
  last.cell.verdict = last.cell.FOUND;  // below the tip: a new one would forbid the way
  last.cell.x = last.injection_pipette.x;
  last.cell.y = last.injection_pipette.y;
  const Eigen::Vector3d start = needle_.place();
  session_.executive().kill("vision");
  session_.run(1);
  const auto silent = go();
  EXPECT_FALSE(silent.success);
  EXPECT_NE(silent.message.find("the tip is not seen"), std::string::npos) << silent.message;
  session_.world().say("/vision/state", last);  // as a relay does
  session_.run(0.1);
  const auto repeated = go();
  EXPECT_FALSE(repeated.success);
  EXPECT_NE(repeated.message.find("the image is old"), std::string::npos) << repeated.message;
  EXPECT_LT((needle_.place() - start).norm(), 1e-9);
}

enum class ImageFault {
  kStops,
  kRepeats,
  kRepeatsOld,
  kLate,
  kBlack,
  kWithoutStamp,
  kCropped,
  kSecondCamera,
  kSecondVision
};
void PrintTo(ImageFault fault, std::ostream* out) {
  static const char* const names[] = {"Stops",      "Repeats",   "RepeatsOld",   "IsLate",        "IsBlack",
                                      "HasNoStamp", "IsCropped", "OfTwoCameras", "SeenByTwoNodes"};
  *out << names[static_cast<int>(fault)];
}

/// While the image leads the needle, the camera fails.
class ImageFaultTest : public VisualServoTest, public testing::WithParamInterface<ImageFault> {
 protected:
  void strike() {
    if (GetParam() == ImageFault::kCropped) return cropImages(session_);
    if (GetParam() == ImageFault::kSecondVision) {
      return session_.executive().network().alter("/vision/state", [](Passage passage) {
        const auto state = boost::make_shared<cell_microinjection::VisionState>(
            *boost::static_pointer_cast<const cell_microinjection::VisionState>(passage.message));
        state->injection_pipette.x -= 40;
        return std::vector<Passage>{passage, {"/stranger", state, 0.03}};
      });
    }
    boost::shared_ptr<const sensor_msgs::Image> first;
    session_.executive().network().alter(
        "/microscope/image_raw", [first, fault = GetParam()](Passage passage) mutable -> std::vector<Passage> {
          const auto original = boost::static_pointer_cast<const sensor_msgs::Image>(passage.message);
          if (!first) first = original;
          const bool is_old = fault == ImageFault::kRepeats || fault == ImageFault::kRepeatsOld;
          const auto image = boost::make_shared<sensor_msgs::Image>(is_old ? *first : *original);
          if (fault == ImageFault::kStops) return {};
          if (fault == ImageFault::kRepeats) image->header.stamp = original->header.stamp;
          if (fault == ImageFault::kLate) passage.delay = 0.6;
          if (fault == ImageFault::kBlack) std::fill(image->data.begin(), image->data.end(), 0);
          if (fault == ImageFault::kWithoutStamp) image->header.stamp = ros::Time();
          if (fault == ImageFault::kSecondCamera) {
            std::rotate(image->data.begin(), image->data.begin() + 40, image->data.end());  // another picture
            return {passage, {"/stranger", image, 0.03}};
          }
          passage.message = image;
          return {passage};
        });
  }
  bool said() {
    if (action_.ended() && action_.result()->message.find(reason()) != std::string::npos) return true;
    const auto& all = session_.diagnostics();
    return all.ever("vision: images", reason()) || all.ever("visual_servo: approach", reason());
  }
  std::string reason() const {
    switch (GetParam()) {
      case ImageFault::kRepeats:
      case ImageFault::kBlack:
        return "the camera repeats its last image";
      case ImageFault::kWithoutStamp:
        return "it has no stamp";
      case ImageFault::kLate:
        return "s old";
      case ImageFault::kRepeatsOld:
        return "its stamp is that of the last one";
      case ImageFault::kCropped:
        return "px now, and were of 440 x 640 px";
      case ImageFault::kSecondCamera:
        return "sent by two nodes, /microscope and /stranger";
      case ImageFault::kSecondVision:
        return "sent by two nodes, /stranger and /vision";
      case ImageFault::kStops:
        break;
    }
    return "is stale";
  }
};

TEST_P(ImageFaultTest, HoldsTheNeedleAndIsSaid) {
  needle_.enable();
  cell_microinjection::GoToPixelGoal goal;
  goal.x = kX;
  goal.y = kY;
  action_.send(goal);
  const Eigen::Vector3d start = needle_.place();
  ASSERT_TRUE(session_.until([&] { return (needle_.place() - start).norm() > 1e-6; }, 5));
  session_.diagnostics().clear();
  strike();
  needle_.poses().clear();
  session_.run(1.5);  // the step of the last image, at 50 um/s
  const Eigen::Vector3d rests = needle_.place();
  session_.run(2);
  EXPECT_LT((needle_.place() - rests).norm(), 0.02e-6) << "it goes on without an image";
  EXPECT_GT(needle_.lowest(), start.z() - 0.1e-6) << "it goes to the cell";
  EXPECT_FALSE(action_.ended() && action_.result()->success);
  EXPECT_TRUE(said()) << session_.diagnostics().text("vision: images");
}

INSTANTIATE_TEST_SUITE_P(Matrix, ImageFaultTest,
                         testing::Values(ImageFault::kStops, ImageFault::kRepeats, ImageFault::kRepeatsOld,
                                         ImageFault::kLate, ImageFault::kBlack, ImageFault::kWithoutStamp,
                                         ImageFault::kCropped, ImageFault::kSecondCamera, ImageFault::kSecondVision),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace microinjection
