#include "cell/pose/lip_suction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cell/pose/motion_scene.h"

namespace microinjection {
namespace {

/// Pressure over flow of the film between a sphere and the lip's edge, by sums over its true height.
double filmResistance(const LipSuction& suction, const CellMotionConfig& config, double gap) {
  const double step = 1e-9, width = 4e-6, r = config.radius, e = kLipEdgeRadius;
  double sum = 0;
  for (double x = -width; x <= width; x += step) {
    const double height = gap + r - std::sqrt(r * r - x * x) + e - std::sqrt(e * e - x * x);
    sum += 12 * config.viscosity * step / (height * height * height);
  }
  return sum / (2 * M_PI * suction.sealRadius());
}

TEST(LipSuction, SharesThePressureBetweenFilmAndBore) {
  const CellMotionConfig config;
  const LipSuction suction(holdingMouth(), config);
  const double a = kBoreRadius;
  const double bore =
      8 * config.viscosity * config.bore_length / (M_PI * a * a * a * a) + 1.5 * config.viscosity / (a * a * a);
  for (const double gap : {0.05e-6, 0.2e-6, 0.5e-6}) {
    const double film = filmResistance(suction, config, gap);
    EXPECT_NEAR(1 - suction.share(gap, 0), bore / (film + bore), 0.03 * bore / (film + bore)) << gap;
    EXPECT_NEAR(suction.flow(suction.share(gap, 0)), 1 / (film + bore), 0.03 / (film + bore));
  }
  EXPECT_EQ(suction.share(0, 0), 1);
  EXPECT_NEAR(suction.flow(suction.share(1e-3, 0)), 1 / bore, 1e-6 / bore);
}

TEST(LipSuction, ShareIsTheIntegralsDerivative) {
  const LipSuction suction(holdingMouth(), {});
  for (const double notch : {0.0, suction.notchConductance(20e-12)}) {
    for (double gap = 1e-8; gap < 1e-3; gap *= 1.7) {
      const double h = 1e-4 * gap;
      const double slope = (suction.shareIntegral(gap + h, notch) - suction.shareIntegral(gap - h, notch)) / (2 * h);
      EXPECT_NEAR(slope, suction.share(gap, notch), 1e-6) << gap;
    }
    EXPECT_EQ(suction.shareIntegral(0, notch), 0);
    EXPECT_NEAR(suction.shareIntegral(-1e-7, notch), -1e-7 * suction.share(0, notch), 1e-20);
  }
}

TEST(LipSuction, ANotchLeaks) {
  const CellMotionConfig config;
  const LipSuction suction(holdingMouth(), config);
  EXPECT_EQ(suction.notchConductance(0), 0);
  double last = 1;
  for (const double area : {1e-12, 10e-12, 50e-12}) {
    const double share = suction.share(0, suction.notchConductance(area));
    EXPECT_LT(share, last);
    last = share;
  }
  // A hole of the bore's own radius through a wall of 10 um: all resistances known.
  const double a = kBoreRadius, mu = config.viscosity, four = M_PI * a * a * a * a;
  const double bore = 8 * mu * config.bore_length / four + 1.5 * mu / (a * a * a);
  const double hole = 3 * mu / (a * a * a) + 8 * mu * 2 * kLipEdgeRadius / four;
  EXPECT_NEAR(suction.share(0, suction.notchConductance(M_PI * a * a)), hole / (hole + bore), 1e-9);
}

TEST(LipSuction, KnowsABoreThatIsTooWide) {
  EXPECT_FALSE(LipSuction(holdingMouth(), {}).swallows());
  EXPECT_TRUE(LipSuction(holdingMouth(50e-6), {}).swallows());
  EXPECT_EQ(LipSuction(holdingMouth(50e-6), {}).lateralStiffness(500), 0);
}

/// Against pulls of cells solved in their section (./dev bench slip, scenes A, B, G and H: two that fitted the law, two
/// that did not).
TEST(LipSuction, ReleasesASoftCellNearerToTheBoreThanItTouchesARigidOne) {
  struct Solved {
    double radius, inner, outer, edge, suction, pull;  // m, Pa, N
  };
  for (const Solved& solved :
       {Solved{40e-6, 14e-6, 40e-6, 8e-6, 250, 252.9e-9}, Solved{40e-6, 14e-6, 40e-6, 8e-6, 750, 678.5e-9},
        Solved{30e-6, 9e-6, 24e-6, 2e-6, 400, 126.5e-9}, Solved{60e-6, 20e-6, 50e-6, 6e-6, 600, 971.9e-9}}) {
    CellMotionConfig config;
    config.radius = solved.radius;
    config.modulus = 5e3;
    const PipetteMouth mouth(solved.inner, solved.outer, solved.edge, 1);
    const LipSuction suction(mouth, config);
    EXPECT_DOUBLE_EQ(suction.releasedRadius(0), suction.sealRadius());
    const double pull = solved.suction * M_PI * std::pow(suction.releasedRadius(solved.suction), 2);
    EXPECT_NEAR(pull / solved.pull, 1, 0.03);
    EXPECT_DOUBLE_EQ(CellMotion(config, mouth, {}).limits(-solved.suction).pull(), pull);
    EXPECT_DOUBLE_EQ(suction.releasedRadius(1e6), solved.inner);  // as steep as the bore's wall
  }
}

/// Boussinesq's displacement in the middle of a ring-shaped Hertzian strip whose load is 1 N/m times the cosine of the
/// azimuth, at an azimuth of 0, by sums.
double ringYields(double radius, double half_width, double modulus) {
  const int around = 20000, across = 200;
  double sum = 0;
  for (int i = 0; i < around; ++i) {
    const double theta = 2 * M_PI * (i + 0.5) / around;
    for (int j = 0; j < across; ++j) {
      const double u = 2 * (j + 0.5) / across - 1, at = radius + u * half_width;  // semi-elliptic across the strip
      const double weight = 2 / M_PI * std::sqrt(1 - u * u) * 2 / across;
      const double distance = std::hypot(at * std::cos(theta) - radius, at * std::sin(theta));
      sum += weight * std::cos(theta) / (M_PI * modulus * distance) * radius * 2 * M_PI / around;
    }
  }
  return sum;
}

TEST(LipSuction, YieldsAcrossTheTubeAsAHalfSpaceUnderARing) {
  const CellMotionConfig config;
  const LipSuction suction(holdingMouth(), config);
  const double s = suction.sealRadius(), sine = s / config.radius, modulus = config.contactModulus();
  for (const double pressure : {50.0, 500.0}) {
    // By the difference of two Hertzian loads, the width of each its own.
    const double line = pressure * s / 2 / std::sqrt(1 - sine * sine), more = 1.02 * line;
    const auto yields = [&](double q) {
      const double width = std::sqrt(4 * q / (M_PI * modulus) / (1 / config.radius + 1 / kLipEdgeRadius));
      return q * ringYields(s, width, modulus);
    };
    const double expected = M_PI * s * sine * sine * (more - line) / (yields(more) - yields(line));
    EXPECT_NEAR(suction.lateralStiffness(pressure) / expected, 1, 0.03) << pressure;
  }
}

}  // namespace
}  // namespace microinjection
