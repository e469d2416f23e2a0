#include "vision/measurement/cell_measurement.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.h"
#include "vision/measurement/measured_scene.h"

namespace microinjection {
namespace {

CellBorder border(double diameter, double deviation) {
  CellBorder border;
  border.finding = Finding::found();
  border.ellipse.semi_axes = Eigen::Vector2d(diameter, diameter) / 2;
  border.covariance(2, 2) = deviation * deviation;
  return border;
}

SpecimenView view(double offset, bool held = true) {
  SpecimenView view;
  view.cell.finding = view.cell.size = Finding::found();
  view.cell.zona_outer = border(300, 0.2);
  view.cell.ooplasm = border(250, 0.2);
  view.cell.centre = {500 + offset, 300};
  view.holding.finding = held ? Finding::found() : Finding::notFound("it is dark");
  view.holding.end = {500, 400};
  view.holding.direction = M_PI / 2;
  view.holding.covariance(0, 0) = 0.01;
  return view;
}

TEST(CellMeasurement, IsInMetresOfTheSpecimen) {
  CellReadings readings(5);
  for (int i = 0; i < 5; ++i) readings.add(view(4));
  std::string reason;
  const auto cell = readings.measure(3, 0.25e-6, reason);
  ASSERT_TRUE(cell) << reason;
  EXPECT_NEAR(cell->diameter.value, 75e-6, 1e-12);
  EXPECT_NEAR(cell->diameter.interval, 1.96 * std::hypot(0.2, 0.05) * 0.25e-6, 1e-12);
  EXPECT_NEAR(cell->zona_thickness->value, 6.25e-6, 1e-12);
  EXPECT_NEAR(cell->offset->value, 1e-6, 1e-12);
  EXPECT_NEAR(cell->offset->interval, 1.96 * 0.1 * 0.25e-6, 1e-12);
  EXPECT_EQ(cell->describe().substr(0, 28), "diameter 75 +- 0.1 um, zona ");
}

TEST(CellMeasurement, LeavesAnOffsetOutThatHalfOfTheImagesLack) {
  CellReadings readings(4);
  for (int i = 0; i < 4; ++i) readings.add(view(4, i % 2 == 0));
  std::string reason;
  EXPECT_FALSE(readings.measure(3, 0.25e-6, reason)->offset);
  readings.add(view(4));  // the first one, with a pipette, leaves
  readings.add(view(4));
  EXPECT_TRUE(readings.measure(3, 0.25e-6, reason)->offset);
}

TEST(CellMeasurement, OfAnotherCellBeginsAnew) {
  CellReadings readings(5);
  for (int i = 0; i < 3; ++i) readings.add(view(40));
  SpecimenView lost = view(0);
  lost.cell.finding = lost.cell.size = Finding::notFound("it is dark");
  readings.add(lost);
  readings.add(view(4));
  std::string reason;
  EXPECT_FALSE(readings.measure(3, 0.25e-6, reason));
  EXPECT_NE(reason.find("it is dark"), std::string::npos);
  EXPECT_NEAR(readings.measure(1, 0.25e-6, reason)->offset->value, 1e-6, 1e-12);
}

TEST(MeasuredScene, HasTheMeasuredLengthsAndNothingElse) {
  CellMeasurement cell;
  cell.diameter = {80e-6, 1e-7};
  cell.zona_thickness = MeasuredLength{7e-6, 1e-7};
  const YAML::Node layered =
      YAML::Load("{cell: {layers: [{outer_radius: 38e-6}, {outer_radius: 32e-6}]}, mesh: {size: 1}}");
  const YAML::Node result = withMeasuredSize(layered, cell);
  EXPECT_NEAR(result["cell"]["layers"][0]["outer_radius"].as<double>(), 40e-6, 1e-12);
  EXPECT_NEAR(result["cell"]["layers"][1]["outer_radius"].as<double>(), 33e-6, 1e-12);
  EXPECT_EQ(result["mesh"]["size"].as<int>(), 1);
  EXPECT_NEAR(layered["cell"]["layers"][0]["outer_radius"].as<double>(), 38e-6, 1e-12);  // it is a copy
  EXPECT_NEAR(withMeasuredSize(YAML::Load("{cell: {diameter: 1}}"), cell)["cell"]["diameter"].as<double>(), 80e-6,
              1e-12);
  cell.zona_thickness->value = 41e-6;
  EXPECT_THROW(withMeasuredSize(layered, cell), ConfigError);
  EXPECT_THROW(withMeasuredSize(YAML::Load("{needle: 1}"), cell), ConfigError);
}

/// With the diameter alone both radii would change in proportion: a zona that nobody has seen.
TEST(MeasuredScene, InventsNoZona) {
  CellMeasurement cell;
  cell.diameter = {80e-6, 1e-7};
  const YAML::Node layered = YAML::Load("{cell: {layers: [{outer_radius: 38e-6}, {outer_radius: 32e-6}]}}");
  EXPECT_THROW(withMeasuredSize(layered, cell), ConfigError);
  EXPECT_NO_THROW(withMeasuredSize(YAML::Load("{cell: {layers: [{outer_radius: 38e-6}]}}"), cell));
}

}  // namespace
}  // namespace microinjection
