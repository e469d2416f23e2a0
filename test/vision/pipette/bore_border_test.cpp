#include "vision/pipette/bore_border.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "vision/microscope/microscope.h"
#include "vision/microscope/scene_draw.h"
#include "vision/pipette/pipette_detector.h"

namespace microinjection {
namespace {

constexpr std::uint64_t kBoreSeeds = 40;
constexpr double kWrongBore = 3;  // px

/// What was measured in the bores of random scenes, with the pipettes where the scene has them.
struct BoreTrials {
  std::vector<double> errors;  ///< px, absolute, of sure ones
  int filled = 0, empty = 0, claimed = 0;

  double median() const {
    std::vector<double> sorted = errors;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
    return sorted[sorted.size() / 2];
  }
  double worst() const { return *std::max_element(errors.begin(), errors.end()); }
  void add(const BoreBorder& border, const std::optional<double>& truth) {
    ++(truth ? filled : empty);
    if (!border.finding.isFound()) return;
    if (!truth) ++claimed;
    if (truth) errors.push_back(std::abs(border.length - *truth));
  }
};

SceneDrawConfig boreScenes() {
  SceneDrawConfig draw;
  draw.holding = draw.injection = 1;
  draw.cell = 0.9;
  draw.inside = 0.3;
  draw.in_needle = 0.6;
  draw.in_holder = 0.8;
  draw.lost = 0.15;
  draw.tip_radius = {2e-6, 5e-6};
  draw.inclination = {0, 0.12};
  return draw;
}

PipetteDetection detectionOf(const PipetteTruth& truth, double taper) {
  PipetteDetection pipette;
  pipette.finding = Finding::found();
  pipette.end = {truth.end.x(), truth.end.y()};
  pipette.direction = std::atan2(truth.axis.y(), truth.axis.x());
  pipette.half_width = truth.radius;
  pipette.taper = taper;
  return pipette;
}

class BoreBorderTest : public testing::Test {
 protected:
  template <typename Measure>
  BoreTrials trials(const Measure& measure) {
    BoreTrials trials;
    for (std::uint64_t seed = 1; seed <= kBoreSeeds; ++seed) {
      const DrawnScene drawn = drawScene(boreScenes(), microscope_.config().camera, seed);
      measure(Frame(microscope_.render(drawn.scene, 0, seed)), drawn, trials);
    }
    return trials;
  }

  Microscope microscope_{MicroscopeConfig()};
};

TEST_F(BoreBorderTest, ColumnsAreWhereTheyAre) {
  const BoreTrials columns = trials([](const Frame& frame, const DrawnScene& drawn, BoreTrials& to) {
    to.add(findColumn(frame, detectionOf(*drawn.truth.injection, drawn.scene.injection->taper)), drawn.truth.in_needle);
  });
  ASSERT_GT(columns.filled, 15);
  ASSERT_GT(columns.empty, 10);
  EXPECT_EQ(columns.claimed, 0);
  EXPECT_GT(columns.errors.size(), columns.filled / 3);
  EXPECT_LT(columns.median(), 0.5);
  EXPECT_LT(columns.worst(), kWrongBore);
}

TEST_F(BoreBorderTest, TonguesAreWhereTheyAre) {
  const BoreTrials tongues = trials([](const Frame& frame, const DrawnScene& drawn, BoreTrials& to) {
    const std::optional<double>& truth = drawn.truth.in_holder;
    if (truth && *truth < 20) return;
    to.add(findTongue(frame, detectionOf(*drawn.truth.holding, 0), true), truth);
  });
  ASSERT_GT(tongues.filled, 10);
  ASSERT_GT(tongues.empty, 3);
  EXPECT_EQ(tongues.claimed, 0);
  EXPECT_GT(tongues.errors.size(), 0.7 * tongues.filled);
  EXPECT_LT(tongues.median(), 0.5);
  EXPECT_LT(tongues.worst(), kWrongBore);
}

/// An interface that moves from image to image is followed to a fraction of a pixel.
TEST_F(BoreBorderTest, AMovingInterfaceIsFollowed) {
  MicroscopeScene scene;
  InjectionPipette pipette;
  pipette.tip_radius = 3e-6;
  scene.injection = pipette;
  const CameraView& view = microscope_.config().camera;
  const PipetteTruth truth{view.pixelOf({0, 0}), view.imageDirection({0, 1}), pipette.tip_radius / view.pixel_size, 0};
  const PipetteDetection seen = detectionOf(truth, pipette.taper);
  EXPECT_EQ(findColumn(Frame(microscope_.render(scene, 0, 1)), seen).finding.verdict, Verdict::kNotFound);
  double first = 0;
  for (int step = 0; step < 6; ++step) {
    const double length = 8e-6 + step * 0.33e-6;
    scene.injection->column = BoreColumn::cytoplasm(length, (1 - pipette.wall) * pipette.tip_radius);
    const BoreBorder border = findColumn(Frame(microscope_.render(scene, 0, 10 + step)), seen);
    ASSERT_TRUE(border.finding.isFound()) << border.finding.reason;
    EXPECT_NEAR(border.length, length / view.pixel_size, 0.6);
    if (step == 0) first = border.length;
    EXPECT_NEAR(border.length - first, step * 0.33e-6 / view.pixel_size, 0.4);
  }
}

TEST_F(BoreBorderTest, WithoutAPipetteNothingIsClaimed) {
  const Frame frame(microscope_.render(MicroscopeScene(), 0, 1));
  EXPECT_EQ(findColumn(frame, PipetteDetection()).finding.verdict, Verdict::kNotFound);
  EXPECT_EQ(findTongue(frame, PipetteDetection(), true).finding.reason, "no pipette was found");
}

}  // namespace
}  // namespace microinjection
