#include "vision/track/specimen_tracker.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "vision/layers/cell_size.h"
#include "vision/microscope/microscope.h"

namespace microinjection {
namespace {

constexpr double kTrackedRadius = 38e-6;  // m
constexpr double kTrackedPixel = 0.3e-6;  // m

/// A held oocyte with a needle above it, as a session has them.
MicroscopeScene heldOocyte(double tip_height) {
  MicroscopeScene scene;
  scene.cells.push_back(CellScene::round({0, 0}, kTrackedRadius, 6e-6, 0));
  HoldingPipette holder;
  holder.mouth = {0, -37e-6};
  holder.outer_radius = 40e-6;
  holder.inner_radius = 13.6e-6;
  scene.holding = holder;
  InjectionPipette needle;
  needle.tip = {0, 0, tip_height};
  needle.tip_radius = 3e-6;
  scene.injection = needle;
  return scene;
}

class SpecimenTrackerTest : public testing::Test {
 protected:
  SpecimenTrackerTest() : microscope_(config()), tracker_(tracking()) {}

  static MicroscopeConfig config() {
    MicroscopeConfig config;
    config.camera.pixel_size = kTrackedPixel;
    return config;
  }
  static SpecimenTrackerConfig tracking() {
    SpecimenTrackerConfig config;
    config.holding.kind = "holding";
    config.holding.direction = M_PI / 2;
    return config;
  }
  const SpecimenView& see(const MicroscopeScene& scene) {
    return tracker_.next(Frame(microscope_.render(scene, 0, ++seed_)));
  }
  cv::Point2d pixel(double x, double z) const {
    const Eigen::Vector2d place = microscope_.config().camera.pixelOf({x, z});
    return {place.x(), place.y()};
  }

  Microscope microscope_;
  SpecimenTracker tracker_;
  std::uint64_t seed_ = 0;
};

TEST_F(SpecimenTrackerTest, FollowsASession) {
  for (const double height : {60e-6, 55e-6, 50e-6, 45e-6}) {
    const SpecimenView& view = see(heldOocyte(height));
    ASSERT_TRUE(view.cell.finding.isFound()) << view.cell.finding.reason;
    EXPECT_LT(cv::norm(view.cell.centre - pixel(0, 0)), 0.3);
    EXPECT_NEAR(view.cell.outer().ellipse.meanDiameter() * kTrackedPixel, 2 * kTrackedRadius, 0.01 * kTrackedRadius);
    ASSERT_TRUE(zonaThickness(view.cell));
    EXPECT_NEAR(zonaThickness(view.cell)->thickness * kTrackedPixel, 6e-6, 0.2e-6);
    ASSERT_TRUE(view.injection.finding.isFound()) << view.injection.finding.reason;
    EXPECT_LT(cv::norm(view.injection.end - pixel(0, height)), 0.5);
    ASSERT_TRUE(view.holding.finding.isFound()) << view.holding.finding.reason;
    EXPECT_LT(cv::norm(view.holding.end - pixel(0, -37e-6)), 1);
  }
}

/// The same frame with twice and with half as many pixels a side shows the same, and is followed as well.
TEST_F(SpecimenTrackerTest, SeesTheSameInOtherSizes) {
  const MicroscopeScene scene = heldOocyte(60e-6);
  const cv::Mat image = microscope_.render(scene, 0, 1), moved = microscope_.render(scene, 0, 2);
  for (const double factor : {2.0, 0.5}) {
    SpecimenTracker tracker(tracking());
    for (const cv::Mat& each : {image, moved}) {
      cv::Mat sized;
      cv::resize(each, sized, {}, factor, factor, factor > 1 ? cv::INTER_CUBIC : cv::INTER_AREA);
      const SpecimenView& view = tracker.next(Frame(sized));
      const auto error = [&](const cv::Point2d& place, const cv::Point2d& truth) {
        return cv::norm(place - (factor * (truth + cv::Point2d(0.5, 0.5)) - cv::Point2d(0.5, 0.5)));
      };
      ASSERT_TRUE(view.cell.finding.hasValues()) << factor;
      EXPECT_LT(error(view.cell.centre, pixel(0, 0)), 0.6) << factor;
      EXPECT_NEAR(view.cell.outer().ellipse.meanDiameter(), 2 * factor * kTrackedRadius / kTrackedPixel, 2) << factor;
      ASSERT_TRUE(view.injection.finding.isFound()) << factor << view.injection.finding.reason;
      EXPECT_LT(error(view.injection.end, pixel(0, 60e-6)), 1) << factor;
      ASSERT_TRUE(view.holding.finding.hasValues()) << factor;
      EXPECT_LT(error(view.holding.end, pixel(0, -37e-6)), 2) << factor;
    }
  }
}

TEST_F(SpecimenTrackerTest, TheLipsOfAThickPipetteAreNoCells) {
  const SpecimenView& view = see(heldOocyte(60e-6));
  EXPECT_TRUE(view.cell.others.empty());
}

TEST_F(SpecimenTrackerTest, AnUncertainCellIsFollowedAndSometimesSearched) {
  const double focus = 10e-6;
  MicroscopeScene scene;
  scene.cells.push_back(CellScene::round({-70e-6, 0}, kTrackedRadius, 6e-6, 0));
  const SpecimenView& view = tracker_.next(Frame(microscope_.render(scene, focus, 1)));
  ASSERT_TRUE(view.cell.finding.hasValues()) << view.cell.finding.reason;
  ASSERT_FALSE(view.cell.size.isFound());
  // The searches become rarer: after the first ones they are 2, 4, 8 and 16 frames apart, then kSearchEvery.
  const Frame alone(microscope_.render(scene, focus, 2));
  for (int i = 0; i < SearchPace::kFirst - 1 + 2 + 4 + 8 + 16 + SpecimenTracker::kSearchEvery; ++i)
    tracker_.next(alone);
  // A second cell is seen by a search of the whole frame only.
  scene.cells.push_back(CellScene::round({70e-6, 0}, kTrackedRadius, 6e-6, 0));
  const Frame both(microscope_.render(scene, focus, 2));
  for (int i = 1; i < SpecimenTracker::kSearchEvery; ++i) {
    tracker_.next(both);
    ASSERT_TRUE(view.cell.others.empty()) << i;
    ASSERT_LT(cv::norm(view.cell.centre - pixel(-70e-6, 0)), 1) << i;
  }
  EXPECT_EQ(tracker_.next(both).cell.otherCells(), 1);
}

TEST_F(SpecimenTrackerTest, WhatIsMissingIsSearchedMoreAndMoreRarely) {
  MicroscopeScene scene = heldOocyte(60e-6);
  scene.injection.reset();
  for (int i = 0; i < 4 * SearchPace::kFirst; ++i) ASSERT_FALSE(see(scene).injection.finding.hasValues()) << i;
  int frames = 1;
  while (!see(heldOocyte(60e-6)).injection.finding.isFound()) ++frames;
  EXPECT_GT(frames, 1);
  EXPECT_LE(frames, SpecimenTracker::kSearchMissingEvery);
}

TEST_F(SpecimenTrackerTest, InAnotherSceneEverythingIsSearched) {
  MicroscopeScene scene = heldOocyte(60e-6);
  scene.injection.reset();
  scene.holding.reset();
  for (int i = 0; i < 4 * SearchPace::kFirst; ++i) ASSERT_FALSE(see(scene).injection.finding.hasValues()) << i;
  MicroscopeScene other = heldOocyte(70e-6);
  other.cells[0] = CellScene::round({50e-6, -20e-6}, 30e-6, 4e-6, 0);
  const SpecimenView& view = see(other);
  EXPECT_TRUE(view.injection.finding.isFound()) << view.injection.finding.reason;
  EXPECT_TRUE(view.cell.finding.isFound()) << view.cell.finding.reason;
}

/// A needle that goes back by more than the reach: where it was, its shaft's edges are gone, and something else may be
/// taken for it.
TEST_F(SpecimenTrackerTest, WhatIsNoLongerSureIsSearchedAtOnce) {
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(see(heldOocyte(45e-6)).injection.finding.isFound());
  const SpecimenView& view = see(heldOocyte(75e-6));
  ASSERT_TRUE(view.injection.finding.isFound()) << view.injection.finding.reason;
  EXPECT_LT(cv::norm(view.injection.end - pixel(0, 75e-6)), 0.5);
}

TEST_F(SpecimenTrackerTest, AnEmptyFrameFindsNothingAndTheNextOneEverything) {
  ASSERT_TRUE(see(heldOocyte(60e-6)).cell.finding.isFound());
  EXPECT_FALSE(tracker_.next(Frame(cv::Mat())).cell.finding.hasValues());
  EXPECT_FALSE(tracker_.view().injection.finding.hasValues());
  EXPECT_FALSE(see(MicroscopeScene()).cell.finding.hasValues());
  MicroscopeScene moved = heldOocyte(60e-6);
  moved.cells[0] = CellScene::round({30e-6, 20e-6}, kTrackedRadius, 6e-6, 0);
  EXPECT_LT(cv::norm(see(moved).cell.centre - pixel(30e-6, 20e-6)), 0.3);
}

TEST_F(SpecimenTrackerTest, AJumpIsSearchedInTheWholeFrame) {
  ASSERT_TRUE(see(heldOocyte(60e-6)).cell.finding.isFound());
  MicroscopeScene moved = heldOocyte(60e-6);
  moved.cells[0] = CellScene::round({-60e-6, 10e-6}, kTrackedRadius, 6e-6, 0);
  const SpecimenView& view = see(moved);
  ASSERT_TRUE(view.cell.finding.isFound()) << view.cell.finding.reason;
  EXPECT_LT(cv::norm(view.cell.centre - pixel(-60e-6, 10e-6)), 0.3);
}

}  // namespace
}  // namespace microinjection
