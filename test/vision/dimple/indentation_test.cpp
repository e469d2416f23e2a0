// The dimple under a needle: its fit on points, and on rendered images with exact truth.

#include "vision/dimple/indentation_contour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "vision/dimple/dented_ellipse.h"
#include "vision/layers/cell_detector.h"
#include "vision/microscope/microscope.h"
#include "vision/microscope/scene_draw.h"
#include "vision/track/specimen_tracker.h"

namespace microinjection {
namespace {

const Ellipse kUndisturbed{{400, 300}, {152, 148}, 0.7};
constexpr double kHidden = 14;  // px, on both sides of the needle's axis

/// The needle above the ellipse's centre, its tip at the bottom of a dent of this depth.
NeedleAxis needleAt(double depth) {
  NeedleAxis axis;
  axis.direction = -M_PI / 2;
  axis.tip = kUndisturbed.centre;
  axis.tip.y += depth - *kUndisturbed.exit(axis.tip, axis.direction);
  return axis;
}

/// Points of the ellipse, dented by shape(distance from the axis) (px); a needle hides those at its axis.
std::vector<BorderPoint> dented(const std::function<double(double)>& shape) {
  std::vector<BorderPoint> points;
  for (int i = 0; i < 240; ++i) {
    const double angle = 2 * M_PI * i / 240;
    BorderPoint point;
    point.normal = {std::cos(angle), std::sin(angle)};
    point.place = kUndisturbed.centre + kUndisturbed.radius(angle) * point.normal;
    const double side = point.place.x - kUndisturbed.centre.x;
    point.facing = std::sin(angle) < -0.1;
    point.trusted = !point.facing || std::abs(side) > kHidden;
    if (point.facing) point.place.y += shape(side);
    // Neighbours deviate alike by up to 0.1 px.
    point.place += 0.1 * std::sin(0.7 * i) * point.normal;
    points.push_back(point);
  }
  return points;
}

TEST(DentedEllipse, IsTheUndisturbedOneBesideADent) {
  for (const double width : {25.0, 40.0}) {
    const double depth = 24;
    const auto points = dented([&](double s) { return depth * std::exp(-0.5 * s * s / (width * width)); });
    // The start leans into the dent.
    Ellipse start = kUndisturbed;
    start.centre.y += 2;
    const NeedleAxis axis = needleAt(depth);
    const DentedEllipse fit = fitDentedEllipse(points, axis, start);
    ASSERT_TRUE(fit.valid);
    EXPECT_NEAR(fit.top(axis), depth, 0.2) << width;
    EXPECT_NEAR(fit.depth, depth, 0.4) << width;
    EXPECT_NEAR(fit.ellipse.centre.y, kUndisturbed.centre.y, 0.1) << width;
    EXPECT_LT(fit.top_deviation, 0.2);
    EXPECT_GT(fit.top_deviation, 0.005);
  }
}

TEST(DentedEllipse, IsTheUndisturbedOneUnderAPunch) {
  // The surface of an elastic half space beside a flat punch of half width a: it has no width of its own.
  const double depth = 16, a = 12;
  const auto points = dented([&](double s) {
    const double height = 1 - std::abs(s) / 150;
    return depth * M_2_PI * std::asin(std::min(1.0, a / std::max(a, std::abs(s)))) * std::min(1.0, 2 * height);
  });
  const NeedleAxis axis = needleAt(depth);
  const DentedEllipse fit = fitDentedEllipse(points, axis, kUndisturbed);
  ASSERT_TRUE(fit.valid);
  EXPECT_NEAR(fit.top(axis), depth, 1.5);
  EXPECT_GT(fit.tail, 0.3);
}

TEST(DentedEllipse, HasNoDentWhereThereIsNone) {
  const NeedleAxis axis = needleAt(0);
  const DentedEllipse fit = fitDentedEllipse(dented([](double) { return 0; }), axis, kUndisturbed);
  ASSERT_TRUE(fit.valid);
  EXPECT_NEAR(fit.depth, 0, 0.5);
  EXPECT_NEAR(fit.top(axis), 0, 0.2);
}

TEST(DentedEllipse, NeedsPoints) {
  std::vector<BorderPoint> points = dented([](double) { return 0; });
  for (std::size_t i = 30; i < points.size(); ++i) points[i].trusted = false;
  EXPECT_FALSE(fitDentedEllipse(points, needleAt(5), kUndisturbed).valid);
}

/// A rendered cell with a needle in its dimple.
struct PressedCell {
  cv::Mat image;
  SceneTruth truth;
  CellDetection cell;
  PipetteDetection needle;  ///< as it is

  explicit PressedCell(std::uint64_t seed, double dimple = 1) {
    SceneDrawConfig draw;
    draw.holding = draw.injection = 1;
    draw.dimple = dimple;
    const MicroscopeConfig config;
    const DrawnScene drawn = drawScene(draw, config.camera, seed);
    image = Microscope(config).render(drawn.scene, 0, seed);
    truth = drawn.truth;
    CellDetectorConfig cells;
    cells.smallest_diameter = 200;
    cells.largest_diameter = 640;
    cell = CellDetector(cells).detect(Frame(image));
    needle.finding = Finding::found();
    needle.end = {truth.injection->end.x(), truth.injection->end.y()};
    needle.direction = std::atan2(truth.injection->axis.y(), truth.injection->axis.x());
    needle.half_width = truth.injection->radius + 2;
    needle.covariance = 0.04 * Eigen::Matrix2d::Identity();
  }
  Dimple find() const { return findIndentation(Frame(image), cell.outer(), needle); }
  double depth() const { return *truth.cell->dimple_depth; }
};

TEST(Dimple, HasTheTrueDepth) {
  for (const std::uint64_t seed : {3, 14, 16, 20, 21, 36}) {
    const PressedCell scene(seed);
    const Dimple found = scene.find();
    ASSERT_TRUE(found.finding.hasValues()) << seed << ": " << found.finding.reason;
    EXPECT_NEAR(found.depth, scene.depth(), 0.6) << seed;
    EXPECT_LT(found.deviation, 0.5) << seed;
    EXPECT_LT(cv::norm(found.outline.centre - cv::Point2d(scene.truth.cell->centre.x(), scene.truth.cell->centre.y())),
              0.4)
        << seed;
  }
}

TEST(Dimple, AWrongTipIsUncertainAndTheOutlineHasTheDepth) {
  for (const double off : {-12.0, 5.0}) {
    PressedCell scene(14);
    scene.needle.end += off * cv::Point2d(std::cos(scene.needle.direction), std::sin(scene.needle.direction));
    const Dimple found = scene.find();
    EXPECT_EQ(found.finding.verdict, Verdict::kUncertain) << off;
    EXPECT_NEAR(found.depth, scene.depth(), 1) << off;
  }
}

TEST(Dimple, ANeedleBeforeTheCellDentsNothing) {
  PressedCell scene(14, 0);
  // The tip is thought to be in the cell, whose outline is round.
  scene.needle.end =
      scene.cell.centre + 0.85 * 0.5 * scene.cell.outer().ellipse.meanDiameter() *
                              cv::Point2d(std::cos(scene.needle.direction), std::sin(scene.needle.direction));
  const Dimple found = scene.find();
  EXPECT_FALSE(found.finding.isFound());
  if (found.finding.hasValues()) EXPECT_LT(found.depth, 1.5);
}

TEST(Dimple, IsNoSurerThanTheOutlineItIsMeasuredFrom) {
  PressedCell scene(14);
  scene.cell.zona_outer.finding = Finding::uncertain("a ring is seen outside of the border");
  EXPECT_FALSE(scene.find().finding.isFound());
  scene.cell.zona_outer.finding = scene.cell.ooplasm.finding = Finding::notFound("nothing");
  EXPECT_FALSE(scene.find().finding.hasValues());
}

/// What the cell is with the needle.
CellDetection withNeedle(const PressedCell& scene) {
  SpecimenView view;
  view.cell = scene.cell;
  view.injection = scene.needle;
  measureIndentation(Frame(scene.image), view);
  return view.cell;
}

double errorOf(const CellDetection& cell, const PressedCell& scene) {
  const Eigen::Vector2d& truth = scene.truth.cell->centre;
  return std::hypot(cell.centre.x - truth.x(), cell.centre.y - truth.y());
}

TEST(Dimple, TheCellHasTheCentreOfItsUndisturbedOutline) {
  for (const std::uint64_t seed : {1, 112, 235}) {
    const PressedCell scene(seed);
    EXPECT_GT(errorOf(scene.cell, scene), 1) << seed << ": the ellipse leans into the dimple";
    const CellDetection cell = withNeedle(scene);
    ASSERT_TRUE(cell.finding.isFound()) << seed << ": " << cell.finding.reason;
    EXPECT_LT(errorOf(cell, scene), 0.3) << seed;
  }
}

TEST(Dimple, ACellWhoseUndisturbedOutlineIsNotFoundIsUncertain) {
  const PressedCell scene(10);
  ASSERT_TRUE(scene.cell.finding.isFound());
  EXPECT_GT(errorOf(scene.cell, scene), 1) << "the ellipse leans into the dimple";
  const CellDetection cell = withNeedle(scene);
  EXPECT_EQ(cell.finding.verdict, Verdict::kUncertain);
  EXPECT_EQ(cell.size.verdict, Verdict::kUncertain);
}

TEST(Dimple, ANeedleBesideTheCellTakesNothingFromIt) {
  const PressedCell scene(3, 0);
  ASSERT_TRUE(scene.cell.size.isFound());
  const CellDetection cell = withNeedle(scene);
  EXPECT_TRUE(cell.size.isFound());
  EXPECT_EQ(cell.centre, scene.cell.centre);
}

}  // namespace
}  // namespace microinjection
