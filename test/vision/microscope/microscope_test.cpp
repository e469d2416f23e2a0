#include "vision/microscope/microscope.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "base/errors.h"
#include "vision/microscope/scene_draw.h"

namespace microinjection {
namespace {

MicroscopeConfig smallConfig(const std::string& look = "bright_field") {
  MicroscopeConfig config;
  config.camera.width = 480;
  config.camera.height = 400;
  config.camera.origin = {239.5, 199.5};
  config.contrast.mode = contrastModeOf(look);
  config.illumination.mottle = 0;
  return config;
}

/// A uniform absorbing disc: nothing but one border.
MicroscopeScene discAt(const Eigen::Vector2d& centre, double radius) {
  MicroscopeScene scene;
  CellScene cell;
  cell.ooplasm = circleOutline(centre, radius);
  cell.cytoplasm = BodyOptics{};
  cell.cytoplasm.absorption = 0.5;
  scene.cells.push_back(cell);
  return scene;
}

double sampleAt(const cv::Mat& image, const Eigen::Vector2d& p) {
  const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y()));
  const double u = p.x() - x, v = p.y() - y;
  return (1 - v) * ((1 - u) * image.at<float>(y, x) + u * image.at<float>(y, x + 1)) +
         v * ((1 - u) * image.at<float>(y + 1, x) + u * image.at<float>(y + 1, x + 1));
}

/// px from `start` along `direction` to the place of `level`, within `length` px; the profile is
/// interpolated between samples a pixel apart, as a camera has them.
double crossing(const cv::Mat& image, const Eigen::Vector2d& start, const Eigen::Vector2d& direction, double level,
                double length) {
  double before = sampleAt(image, start);
  for (double s = 0.05; s < length; s += 0.05) {
    const double now = sampleAt(image, start + s * direction);
    if ((before - level) * (now - level) <= 0 && before != now)
      return s - 0.05 + 0.05 * (level - before) / (now - before);
    before = now;
  }
  return NAN;
}

/// Radius at which a disc's border is seen, averaged over directions: bilinear sampling errs by less
/// than 0.01 px then.
double seenRadius(const cv::Mat& image, const Eigen::Vector2d& centre, double radius, double level) {
  double sum = 0;
  const int directions = 90;
  for (int i = 0; i < directions; ++i) {
    const Eigen::Vector2d direction(std::cos(2 * M_PI * i / directions), std::sin(2 * M_PI * i / directions));
    sum += radius - 15 + crossing(image, centre + (radius - 15) * direction, direction, level, 30);
  }
  return sum / directions;
}

TEST(Microscope, ABorderIsSeenWhereItIs) {
  for (const double angle : {0.0, 0.7}) {
    for (const bool mirrored : {false, true}) {
      MicroscopeConfig config = smallConfig();
      config.camera.angle = angle;
      config.camera.mirrored = mirrored;
      Microscope microscope(config);
      const Eigen::Vector2d centre(3.13e-6, -2.77e-6);
      const cv::Mat image = microscope.transmission(discAt(centre, 30e-6), 0);
      const Eigen::Vector2d seen = config.camera.pixelOf(centre);
      EXPECT_NEAR(seenRadius(image, seen, 120, 0.75), 120, 0.02) << angle << mirrored;
      // The place on opposite sides gives the centre.
      for (const Eigen::Vector2d& axis : {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1)}) {
        const double right = crossing(image, seen + 105 * axis, axis, 0.75, 30);
        const double left = crossing(image, seen - 105 * axis, -axis, 0.75, 30);
        EXPECT_NEAR(right, left, 0.04) << angle << mirrored;
      }
    }
  }
}

/// Exact to rounding when the pixels are small against the blur, so that sampling adds nothing.
TEST(Microscope, AStraightBorderIsExactBetweenPixels) {
  Microscope microscope(smallConfig());
  for (const double shift : {0.0, 0.1, 0.25, 0.5, 0.9}) {
    const double x = (0.5 + shift) * 0.25e-6;  // the origin is at 239.5 px: pixel 240 + shift
    MicroscopeScene scene;
    CellScene cell;
    cell.ooplasm = {{x, -40e-6}, {x + 30e-6, -40e-6}, {x + 30e-6, 40e-6}, {x, 40e-6}};
    cell.cytoplasm = BodyOptics{};
    cell.cytoplasm.absorption = 0.5;
    scene.cells.push_back(cell);
    const cv::Mat image = microscope.transmission(scene, 0);
    // The sum over a row is the area under the edge's profile, which an odd profile leaves in place.
    double dark = 0;
    for (int px = 200; px < 280; ++px) dark += 1 - image.at<float>(200, px);
    EXPECT_NEAR(279.5 - dark / 0.5, 240 + shift, 0.005) << shift;
  }
}

TEST(Microscope, DefocusMovesNoBorder) {
  Microscope microscope(smallConfig());
  const MicroscopeScene scene = discAt({0, 0}, 30e-6);
  for (const double focus : {-10e-6, -4e-6, 4e-6, 10e-6}) {
    const cv::Mat image = microscope.transmission(scene, focus);
    EXPECT_NEAR(seenRadius(image, {239.5, 199.5}, 120, 0.75), 120, 0.03) << focus;
  }
}

/// The rms blur of a border is the spread of its derivative.
TEST(Microscope, DefocusBlursAsConfigured) {
  for (const double condenser : {0.1, 0.3}) {
    MicroscopeConfig config = smallConfig();
    config.objective.condenser_aperture = condenser;
    Microscope microscope(config);
    for (const double focus : {0.0, 6e-6, -6e-6}) {
      const cv::Mat image = microscope.transmission(discAt({0, 0}, 30e-6), focus);
      double sum = 0, second = 0;
      for (int x = 320; x < 400; ++x) {
        const double slope = sampleAt(image, {x + 1.0, 199.5}) - sampleAt(image, {x + 0.0, 199.5});
        sum += slope;
        second += slope * std::pow(x + 0.5 - 359.5, 2);
      }
      const double in_focus = 0.21 * 0.55e-6 / 0.4, defocus = condenser / 2 * focus;
      const double expected = std::hypot(in_focus, defocus) / 0.25e-6;
      // A pixel and the difference of two widen the profile by 1/12 px^2 each.
      EXPECT_NEAR(std::sqrt(second / sum - 2.0 / 12), expected, 0.03 * expected + 0.02) << condenser << " " << focus;
    }
  }
}

TEST(Microscope, BeckesLineChangesSignWithTheFocus) {
  Microscope microscope(smallConfig());
  MicroscopeScene scene = discAt({0, 0}, 30e-6);
  scene.cells[0].cytoplasm.absorption = 0;
  scene.cells[0].cytoplasm.phase = 0.5;
  const Eigen::Vector2d inside(239.5 + 117.5, 199.5), outside(239.5 + 122.5, 199.5);
  const cv::Mat focused = microscope.transmission(scene, 0);
  EXPECT_NEAR(sampleAt(focused, inside), 1, 1e-3);  // a phase object is invisible in focus
  // With the focus towards the camera, the line is in the denser medium.
  const cv::Mat before = microscope.transmission(scene, -4e-6), behind = microscope.transmission(scene, 4e-6);
  EXPECT_GT(sampleAt(before, inside), 1.03);
  EXPECT_LT(sampleAt(before, outside), 0.97);
  EXPECT_LT(sampleAt(behind, inside), 0.97);
  EXPECT_GT(sampleAt(behind, outside), 1.03);
}

TEST(Microscope, PhaseContrastHasAHaloThatCrossesAtTheBorder) {
  Microscope microscope(smallConfig("phase"));
  MicroscopeScene scene = discAt({0, 0}, 30e-6);
  scene.cells[0].cytoplasm.absorption = 0;
  scene.cells[0].cytoplasm.phase = 0.5;
  const cv::Mat image = microscope.transmission(scene, 0);
  EXPECT_LT(sampleAt(image, {239.5 + 116, 199.5}), 0.85);
  EXPECT_GT(sampleAt(image, {239.5 + 124, 199.5}), 1.15);
  EXPECT_NEAR(sampleAt(image, {239.5, 199.5}), 1, 0.03);  // shaded off in the middle
  EXPECT_NEAR(seenRadius(image, {239.5, 199.5}, 120, 1), 120, 0.05);
}

TEST(Microscope, DicShadesAlongItsShearOnly) {
  MicroscopeConfig config = smallConfig("dic");
  config.contrast.shear_angle = 0;
  Microscope microscope(config);
  MicroscopeScene scene = discAt({0, 0}, 30e-6);
  scene.cells[0].cytoplasm.absorption = 0;
  scene.cells[0].cytoplasm.phase = 0.5;
  const cv::Mat image = microscope.transmission(scene, 0);
  const double left = sampleAt(image, {119.5, 199.5}), right = sampleAt(image, {359.5, 199.5});
  EXPECT_GT(left, 1.1);
  EXPECT_NEAR(left + right, 2, 1e-3);
  EXPECT_NEAR(sampleAt(image, {239.5, 79.5}), 1, 0.01);
}

MicroscopeScene richScene(const CameraView& view) {
  SceneDrawConfig draw;
  draw.polar_body = draw.nucleus = draw.holding = draw.injection = draw.dimple = 1;
  draw.bubbles = 2;
  draw.diameter = {50e-6, 60e-6};
  return drawScene(draw, view, 4).scene;
}

TEST(Microscope, TheSameSeedGivesTheSamePicture) {
  for (const char* look : {"bright_field", "phase", "dic"}) {
    MicroscopeConfig config = smallConfig(look);
    config.sensor.jpeg_quality = 80;
    Microscope first(config), second(config);
    const MicroscopeScene scene = richScene(config.camera);
    second.render(scene, 7e-6, 9);  // what was rendered before leaves no trace
    const cv::Mat a = first.render(scene, 2e-6, 5), b = second.render(scene, 2e-6, 5),
                  c = second.render(scene, 2e-6, 6);
    EXPECT_EQ(cv::norm(a, b, cv::NORM_INF), 0) << look;
    EXPECT_GT(cv::norm(a, c, cv::NORM_L1), 0) << look;
  }
}

/// In bright field a zona's border is the middle of its dark line, and an ooplasm's is half-way from
/// the dark rim to the bright line.
TEST(Microscope, TheBordersOfACellAreWhereTheLinesShowThem) {
  Microscope microscope(smallConfig());
  MicroscopeScene scene;
  CellScene cell = CellScene::round({0, 0}, 40e-6, 8e-6, 4e-6);
  cell.zona.granules = cell.cytoplasm.granules = 0;
  scene.cells.push_back(cell);
  const cv::Mat image = microscope.transmission(scene, 0);
  for (const double radius : {40.0, 32.0}) {
    double sum = 0, first = 0;
    for (double r = radius / 0.25 - 6; r <= radius / 0.25 + 6; r += 0.5) {
      double dark = 0;
      for (int i = 0; i < 60; ++i) {
        const Eigen::Vector2d direction(std::cos(M_PI * i / 30), std::sin(M_PI * i / 30));
        dark += 1 - sampleAt(image, Eigen::Vector2d(239.5, 199.5) + r * direction);
      }
      sum += dark;
      first += dark * r;
    }
    EXPECT_NEAR(first / sum, radius / 0.25, 0.06) << radius;
  }
  const double level = 1 + (-0.42 - 0.10 + 0.22) / 2;
  EXPECT_NEAR(seenRadius(image, {239.5, 199.5}, 112, level), 112, 0.06);
}

TEST(Microscope, TheTextureMovesWithTheCell) {
  Microscope microscope(smallConfig());
  MicroscopeScene scene;
  scene.cells.push_back(CellScene::round({0, 0}, 30e-6, 5e-6, 1e-6));
  const cv::Mat here = microscope.transmission(scene, 0);
  scene.cells[0] = CellScene::round({2.5e-6, -5e-6}, 30e-6, 5e-6, 1e-6);  // 10 px right, 20 px down
  const cv::Mat there = microscope.transmission(scene, 0);
  const cv::Rect middle(180, 140, 120, 120);
  EXPECT_LT(cv::norm(here(middle), there(middle + cv::Point(10, 20)), cv::NORM_INF), 2e-3);
  EXPECT_GT(cv::norm(here(middle), there(middle), cv::NORM_INF), 0.05);
}

TEST(Microscope, WhatIsOutOfTheImageLeavesItEmpty) {
  Microscope microscope(smallConfig("phase"));
  MicroscopeScene scene = discAt({1, 1}, 30e-6);
  scene.holding = HoldingPipette{};
  scene.holding->mouth = {0, -1};
  scene.debris.push_back({Debris::Kind::kBubble, {-1, 0, 3}, 10e-6});
  EXPECT_EQ(cv::norm(microscope.transmission(scene, 0), cv::Mat(400, 480, CV_32F, cv::Scalar(1)), cv::NORM_INF), 0);
}

/// A needle whose tip is far outside: its shaft is still seen, as wide as the taper has made it.
TEST(Microscope, AShaftIsSeenWithoutItsTip) {
  Microscope microscope(smallConfig());
  MicroscopeScene scene;
  scene.injection = InjectionPipette{};
  scene.injection->optics = {0, -0.5, 0.4, 0.5, 0, 1e-12};  // a bar that absorbs half between the inner walls
  scene.injection->tip = {0, 0, -1e-3};
  scene.injection->taper = 0.01;
  const cv::Mat image = microscope.transmission(scene, 0);
  const double inner = (1e-6 + 0.01 * 1e-3) * 0.75 / 0.25e-6;
  EXPECT_NEAR((480 - cv::sum(image.row(199))[0]) / 0.5, 2 * inner, 0.2);
  scene.injection->tip.z() = 1;  // and nothing of a needle that points away
  EXPECT_EQ(cv::norm(microscope.transmission(scene, 0), cv::Mat(400, 480, CV_32F, cv::Scalar(1)), cv::NORM_INF), 0);
}

TEST(Microscope, RefusesWhatCannotBeRendered) {
  Microscope microscope(smallConfig());
  MicroscopeScene scene = discAt({NAN, 0}, 30e-6);
  scene.injection = InjectionPipette{};
  scene.injection->axis = {0, 1, 0};
  scene.debris.push_back({Debris::Kind::kDust, {0, 0, 0}, 0});
  try {
    microscope.render(scene, 0, 1);
    FAIL();
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    for (const char* part : {"ooplasm has a corner", "injection axis in the image", "debris radius = 0"})
      EXPECT_NE(text.find(part), std::string::npos) << text;
  }
  EXPECT_THROW(microscope.render({}, NAN, 1), ConfigError);
}

}  // namespace
}  // namespace microinjection
