#include "vision/segmentation_training/label_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

namespace microinjection {
namespace {

CameraView smallView() {
  CameraView view;
  view.width = 320;
  view.height = 240;
  view.pixel_size = 0.5e-6;
  view.origin = {159.5, 119.5};
  return view;
}

PixelClass classAt(const cv::Mat& label, const CameraView& view, double x, double z) {
  const Eigen::Vector2d pixel = view.pixelOf({x, z});
  return static_cast<PixelClass>(
      label.at<unsigned char>(static_cast<int>(std::lround(pixel.y())), static_cast<int>(std::lround(pixel.x()))));
}

double areaOf(const cv::Mat& label, PixelClass value) { return cv::countNonZero(label == static_cast<int>(value)); }

TEST(LabelImage, OfAnEmptySceneIsBackground) { EXPECT_EQ(cv::countNonZero(labelImage({}, smallView())), 0); }

TEST(LabelImage, OfACellHasTheAreasOfItsLayers) {
  const CameraView view = smallView();
  MicroscopeScene scene;
  scene.cells.push_back(CellScene::round({3e-6, -2e-6}, 45e-6, 6e-6, 4e-6));
  scene.cells.front().y = 12e-6;  // out of focus: the label stays
  const cv::Mat label = labelImage(scene, view);
  const auto disc = [&](double radius) { return M_PI * std::pow(radius / view.pixel_size, 2); };
  EXPECT_NEAR(areaOf(label, PixelClass::kOoplasm), disc(35e-6), 0.005 * disc(35e-6));
  EXPECT_NEAR(areaOf(label, PixelClass::kPerivitellineSpace), disc(39e-6) - disc(35e-6), 0.02 * disc(20e-6));
  EXPECT_NEAR(areaOf(label, PixelClass::kZona), disc(45e-6) - disc(39e-6), 0.02 * disc(20e-6));
  EXPECT_EQ(classAt(label, view, 3e-6, -2e-6), PixelClass::kOoplasm);
}

TEST(LabelImage, TurnsWithTheView) {
  CameraView view = smallView();
  view.angle = 0.7;
  view.mirrored = true;
  MicroscopeScene scene;
  scene.cells.push_back(CellScene::round({20e-6, 15e-6}, 12e-6, 0, 0));
  const cv::Mat label = labelImage(scene, view);
  EXPECT_EQ(classAt(label, view, 20e-6, 15e-6), PixelClass::kOoplasm);
  EXPECT_EQ(classAt(label, view, -20e-6, 15e-6), PixelClass::kBackground);
}

TEST(LabelImage, OfAHoldingPipetteHasGlassAndBore) {
  const CameraView view = smallView();
  MicroscopeScene scene;
  HoldingPipette pipette;
  pipette.mouth = {0, 0};
  pipette.axis = {1, 0};
  pipette.outer_radius = 20e-6;
  pipette.inner_radius = 10e-6;
  scene.holding = pipette;
  const cv::Mat label = labelImage(scene, view);
  EXPECT_EQ(classAt(label, view, 30e-6, 0), PixelClass::kBoreMedium);
  EXPECT_EQ(classAt(label, view, 30e-6, 15e-6), PixelClass::kHoldingPipette);
  EXPECT_EQ(classAt(label, view, 30e-6, -15e-6), PixelClass::kHoldingPipette);
  EXPECT_EQ(classAt(label, view, 30e-6, 21e-6), PixelClass::kBackground);
  EXPECT_EQ(classAt(label, view, -2e-6, 0), PixelClass::kBackground);
  // The lip is round: on the middle of the wall the glass begins at the mouth, on its outside later.
  EXPECT_EQ(classAt(label, view, 1e-6, 15e-6), PixelClass::kHoldingPipette);
  EXPECT_EQ(classAt(label, view, 1e-6, 19.5e-6), PixelClass::kBackground);
}

TEST(LabelImage, GlassHidesACellAndItsBoreDoesNot) {
  const CameraView view = smallView();
  MicroscopeScene scene;
  scene.cells.push_back(CellScene::round({0, 0}, 30e-6, 0, 0));
  HoldingPipette pipette;
  pipette.mouth = {20e-6, 0};
  pipette.axis = {1, 0};
  pipette.outer_radius = 20e-6;
  pipette.inner_radius = 10e-6;
  scene.holding = pipette;
  const cv::Mat label = labelImage(scene, view);
  EXPECT_EQ(classAt(label, view, 25e-6, 0), PixelClass::kOoplasm);
  EXPECT_EQ(classAt(label, view, 25e-6, 14e-6), PixelClass::kHoldingPipette);
  EXPECT_EQ(classAt(label, view, 40e-6, 0), PixelClass::kBoreMedium);
}

TEST(LabelImage, OfANeedleWidensAsItDoes) {
  const CameraView view = smallView();
  MicroscopeScene scene;
  InjectionPipette needle;
  needle.tip = {-20e-6, 3e-6, 0};
  needle.axis = {1, 0, 0};
  needle.tip_radius = 2e-6;
  needle.taper = 0.1;
  needle.shaft_radius = 40e-6;
  scene.injection = needle;
  const cv::Mat label = labelImage(scene, view);
  EXPECT_EQ(classAt(label, view, -21e-6, 0), PixelClass::kBackground);
  EXPECT_EQ(classAt(label, view, -19e-6, 0), PixelClass::kInjectionPipette);
  // 60 um behind the tip its half width is 2 um + 0.1 * 60 um.
  EXPECT_EQ(classAt(label, view, 40e-6, 7.4e-6), PixelClass::kInjectionPipette);
  EXPECT_EQ(classAt(label, view, 40e-6, 8.6e-6), PixelClass::kBackground);
}

TEST(LabelImage, NamesBubblesAndDebris) {
  const CameraView view = smallView();
  MicroscopeScene scene;
  scene.debris.push_back({Debris::Kind::kBubble, {-30e-6, 0, 0}, 10e-6});
  scene.debris.push_back({Debris::Kind::kDust, {30e-6, 0, 0}, 4e-6});
  scene.debris.push_back({Debris::Kind::kDust, {0, 0, 0}, 0.2e-6});  // smaller than a pixel
  const cv::Mat label = labelImage(scene, view);
  EXPECT_EQ(classAt(label, view, -30e-6, 0), PixelClass::kBubble);
  EXPECT_EQ(classAt(label, view, 30e-6, 0), PixelClass::kDebris);
  EXPECT_EQ(classAt(label, view, 0, 0), PixelClass::kBackground);
}

}  // namespace
}  // namespace microinjection
