#include "cell/family/axis_force.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

double root(int index) { return static_cast<double>(index + 1) / kAxisDepths; }

/// Hertz at first, stiffer deep in the cell.
double hertz(double s) { return 0.3 * std::pow(s, 3) * (1 + 2 * std::pow(s, 4)); }

TEST(AxisForce, ACurveGoesThroughItsForcesAndIsSmoothBetweenThem) {
  Eigen::VectorXd logs(kAxisDepths);
  for (int i = 0; i < kAxisDepths; ++i) logs[i] = std::log(hertz(root(i)));
  const AxisCurve curve = axisCurve(logs);
  for (int i = 0; i < kAxisDepths; ++i) EXPECT_NEAR(curve(root(i)) / hertz(root(i)), 1, 1e-12);
  for (double s = root(0); s < 1; s += 0.01) EXPECT_NEAR(curve(s) / hertz(s), 1, 1e-3) << s;
}

TEST(AxisForce, AFieldThatIsScaledToACurveHasItsForceOnTheAxis) {
  const EnergyScales scales{1, 1, 1};
  ForceField field(scales);
  Eigen::VectorXd coefficients = Eigen::VectorXd::Zero(field.coefficients().size());
  coefficients.array() += 1e-4;
  coefficients[coefficients.size() - EnergyExpansion(scales, {4, 4, 7, 1}).size()] = 1;  // force proportional to depth
  field.setCoefficients(coefficients);
  const AxisCurve wanted = [](double s) { return 2 * s * s * (1 + 0.5 * s); };
  field.scaleAlongPaths(axisRatio(wanted, axisCurve(field, scales), 1));
  const AxisCurve scaled = axisCurve(field, scales);
  for (double s = 0.2; s < 1; s += 0.05) EXPECT_NEAR(scaled(s) / wanted(s), 1, 0.01) << s;
}

TEST(AxisForce, ARatioIsConstantWhereACurveIsNotKnown) {
  const AxisCurve ratio = axisRatio([](double s) { return s * s; }, [](double s) { return s; }, 0.81);
  EXPECT_NEAR(ratio(0.5), 0.5, 1e-12);
  EXPECT_NEAR(ratio(0.001), root(0), 1e-12);
  EXPECT_NEAR(ratio(1), 0.9, 1e-12);
}

}  // namespace
}  // namespace microinjection
