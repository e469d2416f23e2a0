#include "vision/measurement/sharpness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "vision/calibration/tip_focus.h"
#include "vision/microscope/microscope.h"

namespace microinjection {
namespace {

TEST(CoreSharpness, HasItsPeakInTheTipsFocus) {
  for (const char* look : {"bright_field", "phase", "dic"}) {
    for (const double depth : {0.0, 2.4e-6}) {
      MicroscopeConfig config;
      config.contrast.mode = contrastModeOf(look);
      Microscope microscope(config);
      MicroscopeScene scene;
      InjectionPipette needle;
      needle.tip = {5e-6, depth, 60e-6};
      needle.tip_radius = 3e-6;
      needle.taper = 0.07;
      needle.shaft_radius = 10e-6;
      scene.injection = needle;
      scene.cells.push_back(CellScene::round({0, 0}, 28e-6, 0, 0));
      const Eigen::Vector2d pixel = config.camera.pixelOf({5e-6, 60e-6});
      const TipInImage window{{pixel.x(), pixel.y()}, -M_PI / 2, 3};
      std::vector<FocusSample> samples;
      for (int plane = -7; plane <= 9; ++plane) {
        const Frame frame(microscope.render(scene, 1e-6 * plane, 40 + plane));
        samples.push_back({1e-6 * plane, coreSharpness(frame, window)});
      }
      const FocusReport report = findFocus(samples, {});
      ASSERT_EQ(report.verdict, FocusVerdict::kFocus) << look << ' ' << depth << ": " << report.text;
      EXPECT_NEAR(report.height, depth, 0.3e-6) << look;
    }
  }
}

TEST(CoreSharpness, IsZeroOutsideOfTheImage) {
  cv::Mat image(300, 400, CV_8U, cv::Scalar(100));
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x)
      image.at<unsigned char>(y, x) = static_cast<unsigned char>(90 + (7 * x + y) % 9);
  }
  EXPECT_EQ(coreSharpness(Frame(image), {{900, 900}, 0, 3}), 0);
}

}  // namespace
}  // namespace microinjection
