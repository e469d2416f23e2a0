#include "cell/identification/table_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "base/errors.h"
#include "cell/identification/point_identification.h"

namespace microinjection {
namespace {

std::vector<double> depths() {
  std::vector<double> result;
  for (int k = 1; k <= 16; ++k) result.push_back(45e-6 * k * k / 256);
  return result;
}

TableLaw lawOf(double (*force)(double), double error = 0) {
  std::vector<double> forces;
  for (const double depth : depths()) forces.push_back(force(depth));
  return {"made up", depths(), forces, error};
}

TEST(TableLaw, IsExactForAPower) {
  const TableLaw law = lawOf([](double depth) { return 3e-4 * std::pow(depth, 1.5); });
  Eigen::VectorXd none;
  for (const double depth : {1e-9, 0.3e-6, 7e-6, 44e-6, 50e-6}) {
    const double force = 3e-4 * std::pow(depth, 1.5);
    EXPECT_NEAR(law.force(depth, none).force, force, 1e-9 * force) << depth;
    EXPECT_NEAR(law.force(depth, none).stiffness, 1.5 * force / depth, 1e-9 * force / depth) << depth;
  }
  EXPECT_EQ(law.force(-1e-6, none).force, 0);
  EXPECT_NEAR(law.deepest(), 45e-6, 1e-15);
}

double stiffening(double depth) { return 3e-4 * std::pow(depth, 1.5) * (1 + depth / 20e-6); }

TEST(TableLaw, FollowsACurveThatIsNoPower) {
  const TableLaw law = lawOf(stiffening);
  Eigen::VectorXd none;
  constexpr double kStep = 1e-10;
  for (const double depth : {0.5e-6, 3e-6, 11e-6, 30e-6, 44e-6}) {
    EXPECT_NEAR(law.force(depth, none).force, stiffening(depth), 2e-3 * stiffening(depth)) << depth;
    const double slope = (law.force(depth + kStep, none).force - law.force(depth - kStep, none).force) / (2 * kStep);
    EXPECT_NEAR(law.force(depth, none).stiffness, slope, 1e-4 * slope) << depth;
  }
}

TEST(TableLaw, RefusesWhatIsNoTable) {
  EXPECT_THROW(TableLaw("", {1e-6}, {1e-6}, 0), std::invalid_argument);
  EXPECT_THROW(TableLaw("", {2e-6, 1e-6}, {1e-6, 1e-6}, 0), std::invalid_argument);
  EXPECT_THROW(TableLaw("", {1e-6, 2e-6}, {1e-6, -1e-6}, 0), std::invalid_argument);
}

TEST(IdentifyPoint, HasTheModulusThatGoesThroughThePoint) {
  const TableLaw law = lawOf(stiffening);
  MeasuredPoint point;
  point.depth = 30e-6;
  point.force = 5e3 * stiffening(30e-6);
  point.reading_error = 0.05;
  const Identification found = identifyPoint(point, law);
  const Estimate& modulus = *found.find("young_modulus");
  EXPECT_NEAR(modulus.value, 5e3, 5);
  EXPECT_NEAR(modulus.low, 0.95 * 5e3, 5);
  EXPECT_NEAR(modulus.high, 1.05 * 5e3, 5);
  EXPECT_EQ(found.warnings.size(), 1U);
}

TEST(IdentifyPoint, ItsIntervalHasTheErrorsOfDepthAndLaw) {
  MeasuredPoint point;
  point.depth = 30e-6;
  point.force = 5e3 * stiffening(30e-6);
  point.reading_error = 0.05;
  point.depth_error = 1e-6;
  // d ln(F) / d depth = 1.5 / depth + 1 / (20 um + depth) = 0.07 / um
  const Estimate modulus = *identifyPoint(point, lawOf(stiffening, 0.01)).find("young_modulus");
  const double half = std::hypot(0.05, 0.07, 1.96 * 1.4826 * 0.01);
  EXPECT_NEAR(modulus.high / modulus.value - 1, half, 1e-3);
  point.depth = 46e-6;
  EXPECT_THROW(identifyPoint(point, lawOf(stiffening)), ConfigError);
}

}  // namespace
}  // namespace microinjection
