#include "vision/layers/cell_detector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "vision/microscope/microscope.h"
#include "vision/microscope/scene_draw.h"

namespace microinjection {
namespace {

CellDetectorConfig forRendered() {
  CellDetectorConfig config;
  config.smallest_diameter = 200;
  config.largest_diameter = 640;
  return config;
}

SceneDrawConfig oneCell() {
  SceneDrawConfig draw;
  draw.dimple = draw.injection = draw.holding = 0;
  draw.gap = {0.05, 0.08};
  draw.zona = {0.12, 0.2};
  return draw;
}

struct RenderedCell {
  cv::Mat image;
  SceneTruth truth;
};

RenderedCell renderCell(const SceneDrawConfig& draw, std::uint64_t seed, MicroscopeConfig config = {},
                        double focus = 0) {
  Microscope microscope(config);
  const DrawnScene drawn = drawScene(draw, config.camera, seed);
  return {microscope.render(drawn.scene, focus, seed), drawn.truth};
}

void expectTruth(const CellDetection& cell, const CellTruth& truth, double tolerance) {
  ASSERT_TRUE(cell.finding.isFound()) << cell.finding.reason;
  EXPECT_NEAR(cell.centre.x, truth.centre.x(), tolerance);
  EXPECT_NEAR(cell.centre.y, truth.centre.y(), tolerance);
  EXPECT_NEAR(cell.outer().ellipse.meanDiameter(), truth.diameter, 0.003 * truth.diameter);
}

TEST(CellDetector, MeasuresARenderedCell) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const RenderedCell rendered = renderCell(oneCell(), seed);
    expectTruth(CellDetector(forRendered()).detect(Frame(rendered.image)), *rendered.truth.cell, 0.3);
  }
}

TEST(CellDetector, TurnedAndMirroredCamerasSeeTheSameCell) {
  MicroscopeConfig config;
  config.camera.angle = 1.1;
  config.camera.mirrored = true;
  const RenderedCell rendered = renderCell(oneCell(), 7, config);
  expectTruth(CellDetector(forRendered()).detect(Frame(rendered.image)), *rendered.truth.cell, 0.3);
}

TEST(CellDetector, ColourAndSixteenBitGiveTheSame) {
  const RenderedCell rendered = renderCell(oneCell(), 3);
  cv::Mat colour, deep;
  cv::cvtColor(rendered.image, colour, cv::COLOR_GRAY2BGR);
  rendered.image.convertTo(deep, CV_16U, 257);
  const CellDetection plain = CellDetector(forRendered()).detect(Frame(rendered.image));
  for (const cv::Mat& image : {colour, deep}) {
    const CellDetection other = CellDetector(forRendered()).detect(Frame(image));
    ASSERT_TRUE(other.finding.isFound()) << other.finding.reason;
    EXPECT_NEAR(other.centre.x, plain.centre.x, 0.02);
    EXPECT_NEAR(other.outer().ellipse.meanDiameter(), plain.outer().ellipse.meanDiameter(), 0.02);
  }
}

TEST(CellDetector, ClaimsNothingWithoutACell) {
  SceneDrawConfig draw;
  draw.cell = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const CellDetection cell = CellDetector(forRendered()).detect(Frame(renderCell(draw, seed).image));
    EXPECT_FALSE(cell.finding.hasValues()) << seed;
    EXPECT_FALSE(cell.finding.reason.empty());
  }
}

TEST(CellDetector, BubblesBeforeEachOtherAreNoCells) {
  MicroscopeScene scene;
  const auto bubble = [&](double x, double y, double z, double radius) {
    scene.debris.push_back({Debris::Kind::kBubble, {x, y, z}, radius});
  };
  bubble(-36e-6, 5.8e-6, 40e-6, 41e-6);
  bubble(21e-6, -3.7e-6, 31e-6, 68e-6);
  bubble(-110e-6, -4.5e-6, -60e-6, 67e-6);
  bubble(-60e-6, -4.3e-6, -70e-6, 26e-6);
  const CellDetection cell =
      CellDetector(forRendered()).detect(Frame(Microscope(MicroscopeConfig()).render(scene, 0, 1)));
  EXPECT_FALSE(cell.finding.hasValues()) << cell.finding.reason;
  EXPECT_NE(cell.finding.reason.find("bubble"), std::string::npos) << cell.finding.reason;
}

TEST(CellDetector, AnOocyteFullOfLipidIsNoBubble) {
  MicroscopeScene scene;
  scene.cells.push_back(CellScene::round({0, 0}, 55e-6, 7e-6, 2e-6));
  BodyOptics& ooplasm = scene.cells[0].cytoplasm;
  ooplasm.absorption = 0.75;
  ooplasm.rim *= 0.3;
  ooplasm.granules = 0.18;
  const CellDetection cell =
      CellDetector(forRendered()).detect(Frame(Microscope(MicroscopeConfig()).render(scene, 0, 1)));
  EXPECT_TRUE(cell.finding.hasValues()) << cell.finding.reason;
}

TEST(CellDetector, RefusesUselessFramesWithAReason) {
  const cv::Mat frames[] = {cv::Mat(),
                            cv::Mat(10, 500, CV_8U, cv::Scalar(3)),
                            cv::Mat(400, 500, CV_8U, cv::Scalar(255)),
                            cv::Mat(400, 500, CV_8U, cv::Scalar(90)),
                            cv::Mat(400, 500, CV_16U, cv::Scalar(0)),
                            cv::Mat(400, 500, CV_64F, cv::Scalar(0.5))};
  for (const cv::Mat& frame : frames) {
    const CellDetection cell = CellDetector(forRendered()).detect(Frame(frame));
    EXPECT_EQ(cell.finding.verdict, Verdict::kNotFound);
    EXPECT_FALSE(cell.finding.reason.empty());
  }
}

TEST(CellDetector, HalfACellIsNotOne) {
  SceneDrawConfig draw = oneCell();
  draw.centred = true;
  const RenderedCell rendered = renderCell(draw, 4);
  const auto x = static_cast<int>(rendered.truth.cell->centre.x());
  const cv::Mat half = rendered.image.colRange(x, rendered.image.cols);
  EXPECT_FALSE(CellDetector(forRendered()).detect(Frame(half)).finding.isFound());
}

TEST(CellDetector, TwoCellsAreUncertain) {
  SceneDrawConfig draw = oneCell();
  draw.centred = true;
  draw.diameter = {80e-6, 80e-6};
  const RenderedCell rendered = renderCell(draw, 4);
  cv::Mat both;
  const cv::Mat middle = rendered.image.colRange(500, 900);
  cv::hconcat(middle, middle, both);
  const CellDetection cell = CellDetector(forRendered()).detect(Frame(both));
  EXPECT_EQ(cell.finding.verdict, Verdict::kUncertain);
  EXPECT_EQ(cell.size.verdict, Verdict::kUncertain);
  EXPECT_EQ(cell.otherCells(), 1);
  CellDetection followed = CellDetector(forRendered()).track(Frame(both), cell, 8);
  EXPECT_EQ(followed.finding.verdict, Verdict::kUncertain) << "the other one is still there";
  EXPECT_EQ(followed.size.verdict, Verdict::kUncertain);
  followed.dismissOthers([](const Ellipse&) { return true; });
  EXPECT_TRUE(followed.finding.isFound()) << followed.finding.reason;
}

TEST(CellDetector, OutOfFocusTheCentreMayBeSureAndTheDiameterIsNot) {
  int sure = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const RenderedCell rendered = renderCell(oneCell(), seed, {}, 10e-6);
    const CellDetection cell = CellDetector(forRendered()).detect(Frame(rendered.image));
    EXPECT_EQ(cell.size.verdict, Verdict::kUncertain) << seed;
    EXPECT_FALSE(cell.size.reason.empty());
    if (!cell.finding.isFound()) continue;
    ++sure;
    const Eigen::Vector2d& centre = rendered.truth.cell->centre;
    EXPECT_LT(std::hypot(cell.centre.x - centre.x(), cell.centre.y - centre.y()), 1) << seed;
  }
  EXPECT_GE(sure, 1);
}

}  // namespace
}  // namespace microinjection
