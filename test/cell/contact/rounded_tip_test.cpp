#include "cell/contact/rounded_tip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "base/errors.h"
#include "base/finite_difference.h"

namespace microinjection {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;
constexpr double kRoundedRadius = 3e-6;  // m

const std::vector<RoundedTip>& tips() {
  static const std::vector<RoundedTip> all = {RoundedTip::make("hemisphere", kRoundedRadius),
                                              RoundedTip::make("rounded_flat", kRoundedRadius, 1e-6),
                                              RoundedTip::make("rounded_flat", kRoundedRadius, 0.05e-6)};
  return all;
}

enum class Region { kFlat, kEdge, kShaft };

/// Random points by region, from `deep` (m of depth) to a radius outside; all away from where derivatives jump.
class Points {
 public:
  Vector3d in(Region region, const RoundedTip& tip, double deep) {
    const double c = tip.coreRadius(), e = tip.edgeRadius();
    const double distance = between(-deep, kRoundedRadius);
    double rho = 0, z = 0;
    if (region == Region::kFlat) {
      rho = between(0.01, 0.99) * c;
      z = -distance;
    } else if (region == Region::kShaft) {
      rho = c + e + distance;
      z = e + between(0.01, 3) * kRoundedRadius;
    } else {
      const double angle = between(0.02, 0.98) * kPi / 2;  // from downwards
      rho = c + (e + distance) * std::sin(angle);
      z = e - (e + distance) * std::cos(angle);
    }
    const double turn = between(0, 2 * kPi);
    return {rho * std::cos(turn), rho * std::sin(turn), z};
  }
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

 private:
  std::mt19937 random_{1};
};

void expectDerivatives(const RoundedTip& tip, const Vector3d& point) {
  const Gap gap = tip.gap(point);
  const double step = 1e-5 * tip.edgeRadius();
  EXPECT_NEAR(gap.distance, tip.distance(point), 1e-15 * kRoundedRadius);
  EXPECT_NEAR(gap.normal.norm(), 1, 1e-14);
  const auto distance = [&](const Eigen::VectorXd& at) {
    return Eigen::VectorXd(Eigen::VectorXd::Constant(1, tip.distance(at)));
  };
  const auto normal = [&](const Eigen::VectorXd& at) { return Eigen::VectorXd(tip.gap(at).normal); };
  EXPECT_LT(derivativeError(distance, point, gap.normal.transpose(), step), 1e-7) << point.transpose();
  EXPECT_LT(derivativeError(normal, point, gap.curvature, step), 1e-6) << point.transpose();
  EXPECT_LT((gap.curvature * gap.normal).norm() * kRoundedRadius, 1e-9);
}

TEST(RoundedTip, DerivativesAreThoseOfTheDistanceInEveryRegion) {
  Points points;
  for (const RoundedTip& tip : tips()) {
    for (const Region region : {Region::kFlat, Region::kEdge, Region::kShaft}) {
      if (region == Region::kFlat && tip.coreRadius() == 0) continue;
      for (int i = 0; i < 50; ++i) expectDerivatives(tip, points.in(region, tip, 0.9 * tip.edgeRadius()));
    }
  }
}

TEST(RoundedTip, DerivativesInTheCoreAreThoseOfTheNearestFace) {
  Points points;
  const RoundedTip tip = RoundedTip::make("rounded_flat", kRoundedRadius, 1e-6);  // core of 2 um
  for (int i = 0; i < 50; ++i) {
    const double turn = points.between(0, 2 * kPi), depth = points.between(1.05e-6, 2e-6);
    const Vector3d outward(std::cos(turn), std::sin(turn), 0);
    const Vector3d near_flat = points.between(0.02, 0.95) * (kRoundedRadius - depth) * outward + Vector3d(0, 0, depth);
    const Vector3d near_shaft = (kRoundedRadius - depth) * outward + Vector3d(0, 0, points.between(1.05, 3) * depth);
    expectDerivatives(tip, near_flat);
    expectDerivatives(tip, near_shaft);
    EXPECT_EQ(tip.gap(near_flat).normal, -Vector3d::UnitZ());
    EXPECT_LT((tip.gap(near_shaft).normal - outward).norm(), 1e-12);
    EXPECT_NEAR(tip.distance(near_flat), -depth, 1e-12 * kRoundedRadius);
    EXPECT_NEAR(tip.distance(near_shaft), -depth, 1e-12 * kRoundedRadius);
  }
}

/// Against the surface itself, a polygon of many points in the plane of the axis.
TEST(RoundedTip, DistanceIsThatToTheNearestPointOfTheSurface) {
  Points points;
  for (const RoundedTip& tip : tips()) {
    const double c = tip.coreRadius(), e = tip.edgeRadius();
    std::vector<Vector2d> profile;
    constexpr int kPoints = 2000;
    for (int i = 0; i <= kPoints; ++i) {
      const double s = static_cast<double>(i) / kPoints, angle = s * kPi / 2;
      profile.emplace_back(s * c, 0);
      profile.emplace_back(c + e * std::sin(angle), e * (1 - std::cos(angle)));
      profile.emplace_back(kRoundedRadius, e + s * 5 * kRoundedRadius);
    }
    for (int i = 0; i < 200; ++i) {
      const Vector2d at(points.between(0, 2) * kRoundedRadius, points.between(-1, 4) * kRoundedRadius);
      double nearest = std::numeric_limits<double>::infinity();
      for (const Vector2d& point : profile) nearest = std::min(nearest, (point - at).norm());
      const double distance = tip.distance({at.x(), 0, at.y()});
      EXPECT_NEAR(std::abs(distance), nearest, 3e-3 * kRoundedRadius) << at.transpose();
      const bool above_end =
          at.y() > (at.x() <= c ? 0 : e - std::sqrt(std::max(0.0, e * e - (at.x() - c) * (at.x() - c))));
      EXPECT_EQ(distance < 0, at.x() < kRoundedRadius && above_end) << at.transpose();
    }
  }
}

TEST(RoundedTip, IsSmoothAcrossTheBordersOfItsRegions) {
  for (const RoundedTip& tip : tips()) {
    const double c = tip.coreRadius(), e = tip.edgeRadius();
    const auto expectSmooth = [&](const Vector3d& border, const Vector3d& across) {
      const double step = 1e-6 * e;
      const Gap one = tip.gap(border - step * across), two = tip.gap(border + step * across);
      EXPECT_NEAR(one.distance, two.distance, 2.1 * step);
      EXPECT_LT((one.normal - two.normal).norm(), 1e-5);
      EXPECT_LT((tip.gap(border).normal - one.normal).norm(), 1e-5);
    };
    for (const double distance : {-0.8 * e, 0.0, 0.5 * e, 2 * kRoundedRadius}) {
      if (c > 0) expectSmooth({0, c, -distance}, Vector3d::UnitY());          // flat to edge
      expectSmooth({-(kRoundedRadius + distance), 0, e}, Vector3d::UnitZ());  // edge to shaft
      if (c == 0) expectSmooth({0, 0, -distance}, Vector3d::UnitX());         // across the axis
    }
  }
}

TEST(RoundedTip, IsFiniteOnTheAxisAndOnTheCoresCorner) {
  for (const RoundedTip& tip : tips()) {
    const double c = tip.coreRadius(), e = tip.edgeRadius();
    for (const Vector3d& point :
         {Vector3d(0, 0, -2e-6), Vector3d(0, 0, 0), Vector3d(0, 0, 0.5 * e), Vector3d(0, 0, e),
          Vector3d(0, 0, kRoundedRadius), Vector3d(0, 0, 20e-6), Vector3d(c, 0, e), Vector3d(-c, 0, e)}) {
      const Gap gap = tip.gap(point);
      EXPECT_TRUE(std::isfinite(gap.distance));
      EXPECT_NEAR(gap.normal.norm(), 1, 1e-14) << point.transpose();
      EXPECT_TRUE(gap.curvature.allFinite()) << point.transpose();
    }
    EXPECT_EQ(tip.gap({0, 0, -1e-6}).normal, -Vector3d::UnitZ());
  }
  const Gap below = tips()[0].gap({0, 0, -1e-6});  // 1 um under the hemisphere, 4 um from its centre
  EXPECT_NEAR(below.distance, 1e-6, 1e-20);
  EXPECT_LT((below.curvature - Eigen::Vector3d(1, 1, 0).asDiagonal().toDenseMatrix() / 4e-6).norm(), 1e-4);
}

TEST(RoundedTip, TouchesTheSphereInOnePoint) {
  constexpr double kCell = 28e-6;
  Points points;
  for (const RoundedTip& tip : tips()) {
    for (const Vector2d& offset : {Vector2d(0, 0), Vector2d(0.4e-6, -0.3e-6), Vector2d(2.5e-6, 1e-6),
                                   Vector2d(-12e-6, 15e-6), Vector2d(26.5e-6, 0), Vector2d(0, 29e-6)}) {
      const Vector3d lowest(offset.x(), offset.y(), tip.touchHeight(kCell, offset));
      const Vector3d touch = tip.touchPoint(kCell, offset);
      EXPECT_NEAR(touch.norm(), kCell, 1e-12 * kCell);
      EXPECT_NEAR(tip.distance(touch - lowest), 0, 1e-9 * kCell) << offset.transpose();
      EXPECT_LT((tip.gap(touch - lowest).normal + touch / kCell).norm(), 1e-6);
      const Vector3d down(0, 0, 1e-9);  // further down it is inside
      EXPECT_LT(tip.distance(touch - (lowest - down)), 0);
      for (int i = 0; i < 3000; ++i) {  // nowhere inside, sampled ever closer to the touched point
        const Vector3d aside(points.between(-1, 1), points.between(-1, 1), points.between(-1, 1));
        const double width = std::pow(10, points.between(-6, 1));
        const Vector3d sample = kCell * (touch / kCell + width * aside).normalized();
        EXPECT_GE(tip.distance(sample - lowest), -1e-9 * kCell) << offset.transpose();
      }
    }
  }
}

TEST(RoundedTip, KnownTouchesAndTipsThatPassBy) {
  const RoundedTip flat = RoundedTip::make("rounded_flat", kRoundedRadius, 1e-6);
  EXPECT_EQ(flat.touchHeight(28e-6, {2e-6, 0}), 28e-6);
  EXPECT_EQ(flat.touchPoint(28e-6, {1e-6, 1e-6}), Vector3d(0, 0, 28e-6));
  // Centres of the ball and of the sphere, 4 um + 1 um apart: 3 um aside and 4 um up.
  EXPECT_NEAR(flat.touchHeight(4e-6, {0, 5e-6}), 3e-6, 1e-18);
  EXPECT_LT((flat.touchPoint(4e-6, {0, 5e-6}) - Vector3d(0, 2.4e-6, 3.2e-6)).norm(), 1e-18);
  EXPECT_TRUE(std::isnan(flat.touchHeight(28e-6, {31e-6, 0})));
  EXPECT_TRUE(flat.touchPoint(28e-6, {31e-6, 0}).hasNaN());
}

TEST(RoundedTip, RefusesWhatIsNoRoundedTip) {
  const auto errors = [](const std::string& shape, double radius, double edge_radius) -> std::string {
    try {
      RoundedTip::make(shape, radius, edge_radius);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(errors("disc", 3e-6, 0).find("shape = disc: must be one of: hemisphere, rounded_flat"), std::string::npos);
  EXPECT_NE(errors("rounded_flat", 3e-6, 0).find("edge_radius = 0 m"), std::string::npos);
  EXPECT_NE(errors("rounded_flat", 3e-6, 3.1e-6).find("edge_radius = 3.1e-06 m"), std::string::npos);
  EXPECT_NE(errors("hemisphere", -1, 0).find("radius = -1 m"), std::string::npos);
  EXPECT_NE(errors("rounded_flat", std::nan(""), 1e-6), "");
  EXPECT_EQ(errors("hemisphere", 3e-6, 0), "");
  EXPECT_EQ(RoundedTip::make("rounded_flat", 3e-6, 3e-6).coreRadius(), 0);
}

}  // namespace
}  // namespace microinjection
