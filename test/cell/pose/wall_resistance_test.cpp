#include "cell/pose/wall_resistance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace microinjection {
namespace {

TEST(WallSeries, IsBrennersTable) {
  // Brenner 1961, table 1: alpha = arcosh(distance of the centre over the radius), and the correction to Stokes' law.
  const std::vector<std::pair<double, double>> table = {
      {0.5, 9.2518}, {1, 3.0361}, {1.5, 1.8375}, {2, 1.4129}, {3, 1.1252}};
  for (const auto& [alpha, factor] : table) EXPECT_NEAR(wallSeries(std::cosh(alpha) - 1).perpendicular, factor, 6e-5);
}

TEST(WallSeries, IsTheTableOfGoldmanCoxAndBrenner) {
  // 1967: distance of the centre over the radius, force of the translation, torque of the rotation.
  struct Entry {
    double distance, force, torque;
  };
  for (const Entry& entry :
       {Entry{10.0677, 1.0591, 1.0003}, Entry{3.7622, 1.1738, 1.0059}, Entry{2.3524, 1.3079, 1.0250},
        Entry{1.5431, 1.5675, 1.0998}, Entry{1.1276, 2.1514, 1.3877}, Entry{1.003202, 4.0223, 2.6793}}) {
    const WallFactors at = wallSeries(entry.distance - 1);
    EXPECT_NEAR(at.parallel, entry.force, 3e-4) << entry.distance;
    EXPECT_NEAR(at.rolling, entry.torque, 3e-4) << entry.distance;
  }
}

TEST(WallSeries, AgreesWithTheFitOfChaouiAndFeuillebois) {
  // Q. J. Mech. Appl. Math. 56 (2003) 381, tables 11 and 13: coefficients of gap^i ln(gap) and of gap^i.
  const auto fit = [](double gap, const std::vector<double>& logarithmic, const std::vector<double>& smooth) {
    double sum = 0;
    for (int i = 5; i >= 0; --i) sum = sum * gap + logarithmic[i] * std::log(gap) + smooth[i];
    return sum;
  };
  for (const double gap : {1e-3, 1e-2, 0.05, 0.1, 0.2}) {
    const WallFactors at = wallSeries(gap);
    EXPECT_NEAR(
        at.parallel,
        fit(gap, {-8 / 15., -64 / 375., 0.011595712294862, -0.002559314461340, 0.002165777707452, 0.000351260314552},
            {0.954293724783876, 0.429450132564500, -0.001897844702304, 0.002058408405495, 0.000096108639584,
             -0.001248147281379}),
        1e-6);
    const double torque =
        fit(gap, {-0.1, -43 / 250., -0.036913066460225, 0.001486892317125, 0.000012689734456, 0.000103798994187},
            {-0.192952745666190, 0.100579155700110, 0.094493729126963, 0.003821112414990, -0.000819028830091,
             -0.000097511506358});
    EXPECT_NEAR(at.coupling, 4 / 3. * torque, 1e-6) << gap;  // the reciprocal theorem: they solved for the other one
    EXPECT_NEAR(
        at.rolling,
        fit(gap,
            {-0.4, -0.528001276176667, -0.212879560114862, -0.035965644690736, -0.006385459746252, 0.000167620439255},
            {0.370892565890165, 0.340079923061464, 0.225531274283815, 0.097897336215370, 0.005878696055717,
             0.001503759398496}),
        1e-6);
  }
}

TEST(WallSeries, HasTheKnownLimits) {
  const double gap = 1e-4;
  // Cox and Brenner 1967 (the constant: 0.9713), and Jeffery's sum of 1/n^3.
  EXPECT_NEAR(wallSeries(gap).perpendicular, 1 / gap + 0.2 * std::log(1 / gap) + 0.9713, 2e-3);
  EXPECT_NEAR(wallSeries(gap).spin, 1.2020569, 6e-4);
  const double near = 1 / 41.0;
  const WallFactors far = wallSeries(40);
  EXPECT_NEAR(far.parallel, 1 / (1 - 9 / 16. * near + std::pow(near, 3) / 8), 1e-6);  // Faxen 1922
  EXPECT_NEAR(far.spin, 1 + std::pow(near, 3) / 8, 1e-8);
}

TEST(WallResistance, FollowsTheSeries) {
  const WallResistance table;
  for (double exponent = -2.99; exponent < 2; exponent += 0.0173) {
    const double gap = std::pow(10, exponent);
    const WallFactors fast = table.at(gap), exact = wallSeries(gap);
    EXPECT_NEAR(fast.perpendicular / exact.perpendicular, 1, 1e-6) << gap;
    EXPECT_NEAR(fast.parallel, exact.parallel, 1e-5) << gap;
    EXPECT_NEAR(fast.coupling, exact.coupling, 1e-5) << gap;
    EXPECT_NEAR(fast.rolling, exact.rolling, 1e-5) << gap;
    EXPECT_NEAR(fast.spin, exact.spin, 1e-5) << gap;
  }
}

TEST(WallResistance, GoesOnBelowAndAboveItsTable) {
  const WallResistance table;
  for (const double gap : {1e-4, 3e-4}) {
    EXPECT_NEAR(table.at(gap).perpendicular / wallSeries(gap).perpendicular, 1, 1e-6);
    EXPECT_NEAR(table.at(gap).parallel / wallSeries(gap).parallel, 1, 1e-3);
    EXPECT_NEAR(table.at(gap).coupling, wallSeries(gap).coupling, 3e-3);
    EXPECT_NEAR(table.at(gap).rolling / wallSeries(gap).rolling, 1, 1e-3);
  }
  EXPECT_NEAR(table.at(100.001).perpendicular, table.at(99.999).perpendicular, 1e-6);
  EXPECT_NEAR(table.at(100.001).parallel, table.at(99.999).parallel, 1e-6);
  EXPECT_NEAR(table.at(1e9).perpendicular, 1, 1e-8);
}

}  // namespace
}  // namespace microinjection
