#include "vision/pipette/pipette_detector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "vision/microscope/microscope.h"
#include "vision/microscope/scene_draw.h"

namespace microinjection {
namespace {

struct RenderedPipettes {
  cv::Mat image;
  SceneTruth truth;
  double injection = 0, holding = 0;  ///< rad, directions of the shafts in the image
};

RenderedPipettes renderPipettes(const SceneDrawConfig& draw, std::uint64_t seed, const MicroscopeConfig& config = {},
                                double focus = 0) {
  Microscope microscope(config);
  const DrawnScene drawn = drawScene(draw, config.camera, seed);
  const Eigen::Vector2d up = config.camera.imageDirection({0, 1});
  return {microscope.render(drawn.scene, focus, seed), drawn.truth, std::atan2(up.y(), up.x()),
          std::atan2(-up.y(), -up.x())};
}

SceneDrawConfig pipettesOnly() {
  SceneDrawConfig draw;
  draw.cell = draw.dimple = 0;
  draw.holding = draw.injection = 1;
  draw.dust = 0;
  draw.inclination = {0, 0.2};
  return draw;
}

PipetteDetection detect(const RenderedPipettes& rendered, const std::string& kind) {
  PipetteDetectorConfig config;
  config.kind = kind;
  config.direction = kind == "holding" ? rendered.holding : rendered.injection;
  return PipetteDetector(config).detect(Frame(rendered.image));
}

void expectEnd(const PipetteDetection& found, const PipetteTruth& truth, double tolerance) {
  ASSERT_TRUE(found.finding.hasValues()) << found.finding.reason;
  EXPECT_NEAR(found.end.x, truth.end.x(), tolerance);
  EXPECT_NEAR(found.end.y, truth.end.y(), tolerance);
  EXPECT_NEAR(std::remainder(found.direction - std::atan2(truth.axis.y(), truth.axis.x()), 2 * M_PI), 0, 0.005);
}

double errorOf(const PipetteDetection& found, const PipetteTruth& truth) {
  return std::hypot(found.end.x - truth.end.x(), found.end.y - truth.end.y());
}

/// Tips of seeds 1 to 12, before a cell that a holding pipette holds.
void expectTips(double focus, double rms, double worst, int sure) {
  SceneDrawConfig draw;
  draw.dimple = 0;
  draw.holding = draw.injection = 1;
  double squares = 0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const RenderedPipettes rendered = renderPipettes(draw, seed, {}, focus);
    const PipetteDetection found = detect(rendered, "injection");
    if (!found.finding.isFound()) continue;
    const double error = errorOf(found, *rendered.truth.injection);
    EXPECT_LT(error, worst) << seed;
    squares += error * error;
    ++count;
  }
  EXPECT_GE(count, sure);
  EXPECT_LT(std::sqrt(squares / count), rms);
}

TEST(PipetteDetector, TipsInFocus) { expectTips(0, 0.2, 0.6, 11); }

TEST(PipetteDetector, TipsTenMicrometresOutOfFocus) { expectTips(10e-6, 0.4, 1, 11); }

TEST(PipetteDetector, ABrightCoreDoesNotMoveTheTip) {
  // The core of these needles is far brighter than their walls are dark.
  SceneDrawConfig draw;
  draw.dimple = 0;
  draw.holding = draw.injection = 1;
  for (const std::uint64_t seed : {114, 296, 369, 394, 260, 378, 189}) {
    const RenderedPipettes rendered = renderPipettes(draw, seed);
    const PipetteDetection found = detect(rendered, "injection");
    ASSERT_TRUE(found.finding.isFound()) << seed << ": " << found.finding.reason;
    EXPECT_LT(errorOf(found, *rendered.truth.injection), 0.35) << seed;
  }
}

TEST(PipetteDetector, FindsTheTip) {
  // A needle of less than 3 px in radius has hardly an end.
  for (const std::uint64_t seed : {1, 4, 5, 6, 9, 13}) {
    const RenderedPipettes rendered = renderPipettes(pipettesOnly(), seed);
    expectEnd(detect(rendered, "injection"), *rendered.truth.injection, 0.6);
  }
}

TEST(PipetteDetector, FindsTheMouth) {
  for (const std::uint64_t seed : {6, 8, 11}) {
    const RenderedPipettes rendered = renderPipettes(pipettesOnly(), seed);
    expectEnd(detect(rendered, "holding"), *rendered.truth.holding, 0.3);
  }
}

TEST(PipetteDetector, AMouthOutOfFocusIsUncertain) {
  for (const std::uint64_t seed : {6, 8, 11}) {
    const RenderedPipettes rendered = renderPipettes(pipettesOnly(), seed, {}, 15e-6);
    EXPECT_NE(detect(rendered, "holding").finding.verdict, Verdict::kFound) << seed;
  }
}

TEST(PipetteDetector, AThinNeedleInDicIsUncertain) {
  MicroscopeConfig config;
  config.contrast.mode = ContrastMode::kDic;
  SceneDrawConfig draw;
  draw.dimple = 0;
  draw.holding = draw.injection = 1;
  // Each is even about a place that is 1.1 px beside its axis.
  for (const std::uint64_t seed : {147, 163, 175, 388}) {
    const RenderedPipettes rendered = renderPipettes(draw, seed, config);
    const PipetteDetection found = detect(rendered, "injection");
    ASSERT_TRUE(found.finding.hasValues()) << seed;
    EXPECT_FALSE(found.finding.isFound()) << seed << ": " << errorOf(found, *rendered.truth.injection) << " px off";
  }
}

TEST(PipetteDetector, TheBordersUnderADimpleAreNoEnd) {
  SceneDrawConfig draw;
  draw.dimple = draw.holding = draw.injection = 1;
  for (const std::uint64_t seed : {106, 213, 342, 671}) {
    const RenderedPipettes rendered = renderPipettes(draw, seed);
    PipetteDetectorConfig config;
    config.direction = rendered.injection;
    const PipetteDetector detector(config);
    PipetteDetection before = detector.detect(Frame(rendered.image));
    before.end += cv::Point2d(4, -3);
    const PipetteDetection found = detector.track(Frame(rendered.image), before, 8);
    if (found.finding.isFound()) EXPECT_LT(errorOf(found, *rendered.truth.injection), 1) << seed;
  }
}

TEST(PipetteDetector, TurnedAndMirrored) {
  MicroscopeConfig config;
  config.camera.angle = 0.6;
  config.camera.mirrored = true;
  const RenderedPipettes rendered = renderPipettes(pipettesOnly(), 4, config);
  expectEnd(detect(rendered, "injection"), *rendered.truth.injection, 0.6);
}

TEST(PipetteDetector, ClaimsNothingWithoutAPipette) {
  SceneDrawConfig draw;
  draw.cell = draw.holding = draw.injection = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const PipetteDetection found = detect(renderPipettes(draw, seed), "injection");
    EXPECT_FALSE(found.finding.hasValues()) << seed;
    EXPECT_FALSE(found.finding.reason.empty());
  }
}

TEST(PipetteDetector, RefusesUselessFrames) {
  EXPECT_EQ(PipetteDetector({}).detect(Frame(cv::Mat())).finding.verdict, Verdict::kNotFound);
  EXPECT_FALSE(PipetteDetector({}).detect(Frame(cv::Mat(300, 300, CV_8U, cv::Scalar(255)))).finding.reason.empty());
}

}  // namespace
}  // namespace microinjection
