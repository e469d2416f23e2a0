#include <gtest/gtest.h>

#include <limits>

#include "operation/display/depth_gauge.h"
#include "operation/display/force_arrow.h"
#include "operation/display/legend.h"
#include "operation/display/readout.h"

namespace microinjection {
namespace {

TEST(ForceArrow, HasTheLengthAndTheDirectionOfTheForce) {
  const auto arrow = forceArrow({0, 0, 10e-6}, {3e-6, 0, 4e-6}, 5);
  ASSERT_TRUE(arrow);
  EXPECT_NEAR((arrow->tail - Eigen::Vector3d(0, 0, 0.1)).norm(), 0, 1e-12);
  EXPECT_NEAR((arrow->head - arrow->tail - Eigen::Vector3d(0.15, 0, 0.2)).norm(), 0, 1e-12);
}

TEST(ForceArrow, ShrinksItsHeadWithAShortShaft) {
  const auto longer = forceArrow({0, 0, 0}, {0, 0, 5e-6}, 5);
  const auto shorter = forceArrow({0, 0, 0}, {0, 0, 0.5e-6}, 5);
  ASSERT_TRUE(longer && shorter);
  EXPECT_LE(shorter->head_length, 0.025 / 2 + 1e-12);
  EXPECT_NEAR(shorter->head_diameter / shorter->head_length, longer->head_diameter / longer->head_length, 1e-12);
}

TEST(ForceArrow, IsAbsentWithoutAForceToShow) {
  EXPECT_FALSE(forceArrow({0, 0, 0}, {0, 0, 0}, 5));
  EXPECT_FALSE(forceArrow({0, 0, 0}, {0, 0, std::numeric_limits<double>::quiet_NaN()}, 5));
}

TEST(Legend, RunsFromZeroToTheRange) {
  const Legend legend = colourLegend({1, 0, -0.5}, 1, {SurfaceQuantity::kDisplacement, 20e-6});
  double lowest = 1, highest = -1;
  for (std::size_t i = 0; i < legend.bar.points.size(); ++i) {
    const double z = legend.bar.points[i].z();
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
    EXPECT_NEAR(legend.bar.colours[i].r, colourOfFraction(z + 0.5).r, 1e-5);
  }
  EXPECT_NEAR(lowest, -0.5, 1e-12);
  EXPECT_NEAR(highest, 0.5, 1e-12);
  ASSERT_GE(legend.labels.size(), 5U);
  EXPECT_EQ(legend.labels[0].text, "0");
  EXPECT_EQ(legend.labels[2].text, "10");
  EXPECT_EQ(legend.labels[4].text, "20");
  EXPECT_NEAR(legend.labels[4].position.z(), 0.5, 1e-12);
}

TEST(Readout, ShowsMicrometresAndMicronewtons) {
  Readout readout;
  readout.state = "in contact";
  readout.indentation = 12.346e-6;
  readout.predicted = ForceParts{3.2101e-6, 0.04e-6};
  readout.hand = Eigen::Vector3d(0, 0, -44e-3);
  const std::vector<ReadoutLine> shown = lines(readout);
  ASSERT_EQ(shown.size(), 7U);
  EXPECT_EQ(shown[0].text, "in contact");
  EXPECT_EQ(shown[1].text, "depth 12.35 um");
  EXPECT_EQ(shown[2].text, "predicted 3.210 uN");
  EXPECT_EQ(shown[2].about, ReadoutLine::About::kPredicted);
  EXPECT_EQ(shown[3].text, "  across 0.040 uN");
  EXPECT_EQ(shown[4].text, "measured - uN");
  EXPECT_EQ(shown[5].text, "  across - uN");
  EXPECT_EQ(shown[6].text, "hand -44.0 mm");
  readout.hand.reset();
  EXPECT_EQ(lines(readout).size(), 6U);
  readout.injection = "indent";
  EXPECT_EQ(lines(readout).size(), 7U);
  EXPECT_EQ(lines(readout)[1].text, "indent");
}

TEST(Readout, PartsAForceAlongAndAcrossThePipette) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 0, 1).normalized();
  const ForceParts parts = partsOf(3 * axis + 0.5 * Eigen::Vector3d::UnitY(), axis);
  EXPECT_NEAR(parts.along, 3, 1e-12);
  EXPECT_NEAR(parts.across, 0.5, 1e-12);
  EXPECT_NEAR(partsOf(-axis, axis).along, -1, 1e-12);
}

TEST(Readout, NamesTheExpectedPuncture) {
  Readout readout;
  readout.puncture = PunctureDepth{9.71e-6, 7e-6, 13.6e-6, 1.5e-6};
  const std::vector<ReadoutLine> shown = lines(readout);
  ASSERT_EQ(shown.size(), 7U);
  EXPECT_EQ(shown[5].text, "puncture at 9.71 um");
  EXPECT_EQ(shown[6].text, "  and 1.5 uN");
  readout.puncture->beyond = true;
  EXPECT_EQ(lines(readout)[5].text, "puncture below 7 um");
  EXPECT_TRUE(depthGauge({0, 0, 0}, 1, *readout.puncture, 1e-6).expected.empty());
}

TEST(DepthGauge, RunsDownwardsFromTheContact) {
  const DepthGauge gauge = depthGauge({1, 0, 2}, 0.5, {10e-6, 8e-6, 18e-6, 1e-6}, 5e-6);
  EXPECT_NEAR(gauge.scale[0].z(), 2, 1e-12);
  EXPECT_NEAR(gauge.scale[1].z(), 1.5, 1e-12) << "20 um";
  ASSERT_EQ(gauge.interval.size(), 2U);
  EXPECT_NEAR(gauge.interval[0].z(), 2 - 0.5 * 8 / 20, 1e-12);
  EXPECT_NEAR(gauge.interval[1].z(), 2 - 0.5 * 18 / 20, 1e-12);
  EXPECT_NEAR(gauge.expected.at(0).z(), 1.75, 1e-12);
  EXPECT_NEAR(gauge.present.at(0).z(), 2 - 0.125, 1e-12);
  EXPECT_EQ(gauge.labels[4].text, "20");
  EXPECT_TRUE(depthGauge({1, 0, 2}, 0.5, {10e-6, 8e-6, 18e-6, 1e-6}, std::nullopt).present.empty());
}

TEST(DepthGauge, HoldsANeedleThatIsDeeperThanExpected) {
  const DepthGauge gauge = depthGauge({0, 0, 0}, 1, {1e-6, 0.5e-6, 2e-6, 1e-6}, 30e-6);
  EXPECT_GE(gauge.present.at(0).z(), -1);
}

TEST(Readout, BreaksALongState) {
  Readout readout;
  readout.state = "no solution: the contact is still being prepared";
  const std::vector<ReadoutLine> shown = lines(readout);
  ASSERT_EQ(shown.size(), 3U + 5);
  EXPECT_EQ(shown[0].text, "no solution: the");
  EXPECT_EQ(shown[1].text, "contact is still");
  EXPECT_EQ(shown[2].text, "being prepared");
  EXPECT_EQ(shown[2].about, ReadoutLine::About::kState);
  readout.state = std::string(200, 'x') + " a b c" + std::string(300, ' ') + std::string(99, 'y') +
                  " z z zzzzzzzzzzzzzzzzzzzz" + " zzzzzzzzzzzzzzzzzzzz zzzzzzzzzzzzzzzzzzzz";
  ASSERT_EQ(lines(readout).size(), 5U + 5);
  EXPECT_EQ(lines(readout)[4].text, "zzzzzzzzzzzzzzzzzzzz ...");
}

}  // namespace
}  // namespace microinjection
