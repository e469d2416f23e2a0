#include "vision/layers/cell_size.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace microinjection {
namespace {

CellBorder border(double diameter, double deviation) {
  CellBorder border;
  border.finding = Finding::found();
  border.ellipse.semi_axes = Eigen::Vector2d(diameter, diameter) / 2;
  border.covariance(2, 2) = deviation * deviation;
  return border;
}

CellDetection cell(double zona, double ooplasm, double deviation = 0.1) {
  CellDetection detection;
  detection.finding = detection.size = Finding::found();
  if (zona > 0) detection.zona_outer = border(zona, deviation);
  detection.ooplasm = border(ooplasm, deviation);
  return detection;
}

TEST(ZonaThickness, IsThatToTheInnerBorder) {
  CellDetection detection = cell(200, 150);
  detection.zona_inner = border(160, 0.3);
  EXPECT_NEAR(zonaThickness(detection)->thickness, 20, 1e-9);
  EXPECT_NEAR(zonaThickness(detection)->deviation, std::hypot(0.1, 0.3) / 2, 0.01);
}

TEST(ZonaThickness, ReachesTheOoplasmWithoutAGap) {
  CellDetection detection = cell(200, 150);
  EXPECT_NEAR(zonaThickness(detection)->thickness, 25, 1e-9);
  detection.ooplasm.rim = 4;
  detection.zona_inner = border(154, 0.3);  // in the middle of the rim
  detection.zona_inner.finding = Finding::uncertain("within the rim");
  EXPECT_NEAR(zonaThickness(detection)->thickness, 25, 1e-9);
  detection.zona_inner.ellipse.semi_axes *= 170.0 / 154;  // far from it: which border it is is not known
  EXPECT_FALSE(zonaThickness(detection));
}

TEST(ZonaThickness, ItsIntervalReachesOverTheRimThatHidesAGap) {
  CellDetection detection = cell(200, 150);
  EXPECT_LT(zonaThickness(detection)->deviation, 0.1);
  detection.ooplasm.rim = 6;
  EXPECT_GT(1.96 * zonaThickness(detection)->deviation, 1.25 * 6);
  detection.zona_inner = border(156, 0.1);  // seen
  EXPECT_LT(zonaThickness(detection)->deviation, 0.1);
}

TEST(ZonaThickness, NeedsAZona) { EXPECT_FALSE(zonaThickness(cell(0, 150))); }

TEST(CellSizeReadings, NeedImagesInSuccession) {
  CellSizeReadings readings(10);
  std::string reason;
  EXPECT_FALSE(readings.measure(3, reason));
  EXPECT_NE(reason.find("0 of 3"), std::string::npos);
  readings.add(cell(200, 150));
  readings.add(cell(200, 150));
  CellDetection lost;
  lost.finding = lost.size = Finding::notFound("it is dark");
  readings.add(lost);
  readings.add(cell(200, 150));
  EXPECT_FALSE(readings.measure(3, reason));
  EXPECT_NE(reason.find("1 of 3"), std::string::npos);
  EXPECT_NE(reason.find("it is dark"), std::string::npos);
}

TEST(CellSizeReadings, ADiameterInDoubtIsNoReading) {
  CellSizeReadings readings(10);
  CellDetection blurred = cell(200, 150);
  blurred.size = Finding::uncertain("it is out of focus");
  for (int i = 0; i < 3; ++i) readings.add(blurred);
  std::string reason;
  EXPECT_FALSE(readings.measure(1, reason));
  EXPECT_NE(reason.find("it is out of focus"), std::string::npos);
}

TEST(CellSizeReadings, AnotherCellBeginsAnew) {
  CellSizeReadings readings(10);
  for (int i = 0; i < 5; ++i) readings.add(cell(200, 150));
  readings.add(cell(215, 150));
  std::string reason;
  EXPECT_EQ(readings.measure(1, reason)->images, 1U);
  EXPECT_EQ(readings.measure(1, reason)->diameter.value, 215);
}

TEST(CellSizeReadings, TheIntervalsCoverTheTruth) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 1);
  int covered = 0;
  constexpr int kSeries = 400;
  for (int series = 0; series < kSeries; ++series) {
    CellSizeReadings readings(15);
    const double common = 0.2 * normal(random);  // what misleads all images alike, as the detector states it
    for (int i = 0; i < 20; ++i) readings.add(cell(200 + common + 0.3 * normal(random), 150, 0.2));
    std::string reason;
    const MeasuredLength diameter = readings.measure(3, reason)->diameter;
    if (std::abs(diameter.value - 200) <= diameter.interval) ++covered;
  }
  EXPECT_NEAR(covered, 0.95 * kSeries, 0.03 * kSeries);
}

TEST(CellSizeReadings, AnOutlierDoesNotMoveTheMedian) {
  CellSizeReadings readings(15);
  for (int i = 0; i < 14; ++i) readings.add(cell(200, 150));
  readings.add(cell(206, 150));
  std::string reason;
  EXPECT_EQ(readings.measure(3, reason)->diameter.value, 200);
  EXPECT_EQ(readings.measure(3, reason)->zona_thickness->value, 25);
}

}  // namespace
}  // namespace microinjection
