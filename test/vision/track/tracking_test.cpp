#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "vision/microscope/microscope.h"
#include "vision/microscope/scene_draw.h"
#include "vision/track/overlay.h"

namespace microinjection {
namespace {

cv::Mat moved(const cv::Mat& image, double x, double y) {
  const cv::Mat shift = (cv::Mat_<double>(2, 3) << 1, 0, x, 0, 1, y);
  cv::Mat result;
  cv::warpAffine(image, result, shift, image.size(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  return result;
}

struct Scene {
  cv::Mat image;
  SceneTruth truth;

  explicit Scene(double dimple = 0) {
    SceneDrawConfig draw;
    draw.holding = draw.injection = 1;
    draw.dimple = dimple;
    draw.dust = 0;
    draw.gap = {0.06, 0.08};
    draw.zona = {0.15, 0.2};
    draw.dimple_depth = {6e-6, 6e-6};
    const MicroscopeConfig config;
    Microscope microscope(config);
    const DrawnScene drawn = drawScene(draw, config.camera, 6);
    image = microscope.render(drawn.scene, 0, 6);
    truth = drawn.truth;
  }
};

CellDetector cells() {
  CellDetectorConfig config;
  config.smallest_diameter = 200;
  config.largest_diameter = 640;
  return CellDetector(config);
}

TEST(Tracking, FollowsTheCell) {
  const Scene scene;
  const CellDetection first = cells().detect(Frame(scene.image));
  ASSERT_TRUE(first.finding.isFound()) << first.finding.reason;
  const CellDetection next = cells().track(Frame(moved(scene.image, 4.25, -3.5)), first, 8);
  ASSERT_TRUE(next.finding.isFound()) << next.finding.reason;
  EXPECT_NEAR(next.centre.x - first.centre.x, 4.25, 0.15);
  EXPECT_NEAR(next.centre.y - first.centre.y, -3.5, 0.15);
}

TEST(Tracking, ACellThatIsGoneIsLost) {
  const Scene scene;
  const CellDetection first = cells().detect(Frame(scene.image));
  cv::Mat empty;
  cv::GaussianBlur(scene.image, empty, cv::Size(0, 0), 60);
  EXPECT_FALSE(cells().track(Frame(empty), first, 8).finding.isFound());
  EXPECT_FALSE(cells().track(Frame(cv::Mat()), first, 8).finding.hasValues());
  EXPECT_FALSE(cells().track(Frame(scene.image), CellDetection(), 8).finding.hasValues());
}

TEST(Tracking, FollowsTheTip) {
  const Scene scene;
  const PipetteDetector detector{PipetteDetectorConfig()};
  const PipetteDetection first = detector.detect(Frame(scene.image));
  ASSERT_TRUE(first.finding.hasValues()) << first.finding.reason;
  const PipetteDetection next = detector.track(Frame(moved(scene.image, -5.5, 3.25)), first, 8);
  ASSERT_TRUE(next.finding.hasValues()) << next.finding.reason;
  EXPECT_NEAR(next.end.x - first.end.x, -5.5, 0.2);
  EXPECT_NEAR(next.end.y - first.end.y, 3.25, 0.2);
}

TEST(Dimple, MeasuresTheDimple) {
  const Scene scene(1);
  const CellDetection cell = cells().detect(Frame(scene.image));
  ASSERT_TRUE(cell.finding.hasValues());
  const PipetteTruth& needle = *scene.truth.injection;
  const Dimple found = findIndentation(Frame(scene.image), cell.outer(), {needle.end.x(), needle.end.y()},
                                       std::atan2(needle.axis.y(), needle.axis.x()), 2 * needle.radius + 4);
  ASSERT_TRUE(found.finding.hasValues()) << found.finding.reason;
  EXPECT_NEAR(found.depth, *scene.truth.cell->dimple_depth, 0.6);
}

TEST(Overlay, DrawsOnlyWhatIsThere) {
  const Scene scene;
  const Frame frame(scene.image);
  const CellDetection cell = cells().detect(frame);
  const cv::Mat with = drawOverlay(frame, {&cell, nullptr, nullptr, nullptr}), without = drawOverlay(frame, {});
  EXPECT_EQ(with.size(), scene.image.size());
  // The border is drawn where it was found.
  cv::Mat difference;
  cv::absdiff(with, without, difference);
  const cv::Point2d on = cell.outer().ellipse.at(0.3);
  const cv::Rect around(static_cast<int>(on.x) - 2, static_cast<int>(on.y) - 2, 5, 5);
  EXPECT_GT(cv::norm(difference(around), cv::NORM_INF), 20);
  EXPECT_FALSE(drawOverlay(Frame(cv::Mat()), {}).empty());
}

}  // namespace
}  // namespace microinjection
