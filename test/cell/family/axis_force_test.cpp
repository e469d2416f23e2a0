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

/// Of both signs, without the highest power of s: a product with a linear function is one of the same degree.
Eigen::VectorXd roughCoefficients(int size, int distance) {
  Eigen::VectorXd coefficients(size);
  for (int i = 0; i < size; ++i) coefficients[i] = i % (distance + 1) == distance ? 0 : std::sin(3.0 * i + 1);
  return coefficients;
}

const Eigen::Vector3d kDirection = Eigen::Vector3d(0.4, -0.2, -1).normalized();

double linear(double s) { return 2 + s; }

TEST(AxisForce, AnExpansionOfAForceIsScaledAlongStraightPaths) {
  const EnergyScales scales{1, 1, 1};
  EnergyExpansion force(scales, {4, 4, 7, 1});
  force.setCoefficients(roughCoefficients(force.size(), 7));
  EnergyExpansion scaled = force;
  scaled.scaleAlongPaths(linear, hertz);
  EnergyExpansion::Local before, after;
  force.makeLocal(0.3, before);
  scaled.makeLocal(0.3, after);
  for (double s = 0.1; s < 1; s += 0.1) {
    const Eigen::Vector3d u = s * s * kDirection;
    EXPECT_NEAR(after.evaluate(u).value, linear(s) * before.evaluate(u).value, 1e-9) << s;
  }
}

TEST(AxisForce, AnEnergyIsScaledByTheForceAlongStraightPaths) {
  const EnergyScales scales{1, 1, 1};
  EnergyExpansion energy(scales, EnergyDegrees());
  energy.setCoefficients(roughCoefficients(energy.size(), EnergyDegrees().distance));
  EnergyExpansion scaled = energy;
  scaled.scaleAlongPaths(linear, hertz);
  EnergyExpansion::Local before, after;
  energy.makeLocal(0.3, before);
  scaled.makeLocal(0.3, after);
  for (double s = 0.1; s < 1; s += 0.1) {
    const Eigen::Vector3d u = s * s * kDirection;
    EXPECT_NEAR(after.evaluate(u).gradient.dot(kDirection), linear(s) * before.evaluate(u).gradient.dot(kDirection),
                1e-8)
        << s;
  }
}

TEST(AxisForce, AFieldThatIsScaledToACurveHasItsForceOnTheAxis) {
  const EnergyScales scales{1, 1, 1};
  ForceField field(scales);
  Eigen::VectorXd coefficients = Eigen::VectorXd::Zero(field.coefficients().size());
  coefficients[coefficients.size() - EnergyExpansion(scales, {4, 4, 7, 1}).size()] = 1;  // force proportional to depth
  field.setCoefficients(coefficients);
  // As two members differ: a factor, and a slope with the depth.
  const AxisCurve wanted = [](double s) { return 1.5 * s * s * (1 + 0.2 * s * s); };
  field.scaleAlongPaths(axisRatio(wanted, axisCurve(field, scales), 1), wanted);
  const AxisCurve scaled = axisCurve(field, scales);
  // Where the ratio becomes constant, at the deepest, it has a kink that a polynomial rounds.
  for (double s = root(0); s < 1; s += 0.02) EXPECT_NEAR(scaled(s) / wanted(s), 1, 0.003) << s;
}

TEST(AxisForce, ARatioIsConstantWhereACurveIsNotKnown) {
  const AxisCurve ratio = axisRatio([](double s) { return s * s; }, [](double s) { return s; }, 0.81);
  EXPECT_NEAR(ratio(0.5), 0.5, 1e-12);
  EXPECT_NEAR(ratio(0.001), root(0), 1e-12);
  EXPECT_NEAR(ratio(1), 0.9, 1e-12);
}

}  // namespace
}  // namespace microinjection
