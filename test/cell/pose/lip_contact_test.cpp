#include "cell/pose/lip_contact.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "cell/pose/motion_scene.h"

namespace microinjection {
namespace {

using Eigen::Vector3d;

constexpr double kSphere = 40e-6, kContactModulus = 1e4;  // m, Pa

LipContact lipContact() { return LipContact(holdingMouth(), kSphere, kContactModulus); }

Vector3d pushOf(const LipContact::Forces& forces) {
  Vector3d sum = Vector3d::Zero();
  if (forces.angle <= 0) return sum;
  for (const LipContact::Point& point : forces.points) sum += point.push * point.normal;
  return sum;
}

TEST(LipContact, ForceIsTheEnergysDerivative) {
  const LipContact lip = lipContact();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> out(0, 85e-6), up(-45e-6, 10e-6), turn(-M_PI, M_PI);
  int touching = 0;
  for (int i = 0; i < 2000; ++i) {
    const double r = out(random), angle = turn(random);
    const Vector3d at(r * std::cos(angle), r * std::sin(angle), up(random));
    const LipContact::Forces forces = lip.at(at);
    const Vector3d push = pushOf(forces);
    // The core itself is 5 um below the glass's surface; a cell deep in the glass is none.
    if (push.norm() < 1e-8 || holdingMouth().distance(at) < 0.3 * kSphere) continue;
    Vector3d slope;
    for (int k = 0; k < 3; ++k) {
      const double h = 1e-10;
      slope[k] = -(lip.at(at + h * Vector3d::Unit(k)).energy - lip.at(at - h * Vector3d::Unit(k)).energy) / (2 * h);
    }
    EXPECT_LT((slope - push).norm() / push.norm(), 0.02) << at.transpose() * 1e6 << " push " << push.transpose();
    EXPECT_LT(std::abs(at.cross(push).z()), 1e-9 * push.norm() * kSphere);  // nothing turns it about the tube
    ++touching;
  }
  EXPECT_GT(touching, 300);
}

TEST(LipContact, IsARingOnTheAxis) {
  const PipetteMouth mouth = holdingMouth();
  const LipContact lip = lipContact();
  const double sink = 0.1e-6, alpha = std::asin(mouth.crestRadius() / (kSphere + kLipEdgeRadius));
  const LipContact::Forces at = lip.at({0, 0, -mouth.touchDistance(kSphere) + sink});
  EXPECT_EQ(at.angle, M_PI);
  // Its whole length, (pi/4) E* and the overlap of the circle's gap, whose normals lean by alpha.
  const double force =
      M_PI / 4 * kContactModulus * 2 * M_PI * mouth.crestRadius() * sink * std::cos(alpha) * std::cos(alpha);
  EXPECT_NEAR(-pushOf(at).z() / force, 1, 2e-3);
  EXPECT_LT(pushOf(at).head<2>().norm(), 1e-12 * force);
  EXPECT_EQ(lip.at({0, 0, -mouth.touchDistance(kSphere) - 1e-9}).angle, 0);
}

TEST(LipContact, IsNearlyHertzOnTheFlatEnd) {
  const LipContact lip = lipContact();
  const double overlap = 0.2e-6, middle = 27e-6;
  const LipContact::Forces at = lip.at({middle, 0, -kSphere + overlap});
  // The foundation's force on a sphere of the cell's radius and the edge's, over Hertz's of the cell's: pi/(2 sqrt 2)
  // and the root of the radii's ratio; its weight is that of the inner edge.
  const double weight = holdingMouth().crestRadius() / middle;
  const double hertz = 4.0 / 3 * kContactModulus * std::sqrt(kSphere) * std::pow(overlap, 1.5);
  EXPECT_NEAR(-pushOf(at).z() / hertz, weight * M_PI / (2 * std::sqrt(2.0)) * std::sqrt(1 + kLipEdgeRadius / kSphere),
              0.01);
  EXPECT_LT(std::abs(pushOf(at).x()), 0.02 * pushOf(at).norm());
}

/// The contact's force by a sum over as many points, which are fixed to the lip.
Vector3d sumOverLip(const Vector3d& centre, int count) {
  const PipetteMouth mouth = holdingMouth();
  const double inner = mouth.crestRadius(), outer = mouth.outerRadius() - mouth.edgeRadius();
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * (i + 0.3) / count;
    const Vector3d out(std::cos(angle), std::sin(angle), 0);
    const Vector3d core = std::clamp(centre.dot(out), inner, outer) * out + kLipEdgeRadius * Vector3d::UnitZ();
    const double overlap = kSphere + kLipEdgeRadius - (centre - core).norm();
    if (overlap > 0)
      sum += M_PI / 4 * kContactModulus * inner * 2 * M_PI / count * overlap * (centre - core).normalized();
  }
  return sum;
}

TEST(LipContact, IsTheIntegralWhileTheCellTipsOverTheLip) {
  const LipContact lip = lipContact();
  double error = 0, of_fixed_points = 0;
  // Around the lip at a constant overlap with it: from the bore's axis to beyond the outside.
  for (double x = 0; x < 55e-6; x += 0.037e-6) {
    const double beyond = x < 15e-6 ? 15e-6 - x : (x > 35e-6 ? x - 35e-6 : 0),
                 reach = kSphere + kLipEdgeRadius - 0.1e-6;
    const Vector3d at(x, 1e-7, kLipEdgeRadius - std::sqrt(reach * reach - beyond * beyond));
    const Vector3d push = pushOf(lip.at(at)), exact = sumOverLip(at, 20000);
    error = std::max(error, (push - exact).norm() / exact.norm());
    of_fixed_points = std::max(of_fixed_points, (sumOverLip(at, LipContact::kPoints) - exact).norm() / exact.norm());
  }
  EXPECT_LT(error, 2e-3);
  EXPECT_GT(of_fixed_points, 0.5);  // what the class avoids
}

TEST(LipContact, LeaksThroughTheOpenSideOnly) {
  const PipetteMouth mouth = holdingMouth();
  const LipContact lip = lipContact();
  const double touch = mouth.touchDistance(kSphere);
  EXPECT_EQ(lip.leakingGap({0, 0, -touch + 1e-8}), 0);
  const double alpha = std::asin(mouth.crestRadius() / (kSphere + kLipEdgeRadius));
  EXPECT_NEAR(lip.leakingGap({0, 0, -touch - 1e-6}) / (1e-6 * std::cos(alpha)), 1, 0.01);
  // Tipped about one point: the gap g (1 - cos(phi)), whose mean of (1 - cos)^(5/2) is 2^(5/2) 16 / (15 pi).
  const double tip = 0.01, radius = mouth.crestRadius(), depth = touch + kLipEdgeRadius;
  const Vector3d tipped(radius - radius * std::cos(tip) + depth * std::sin(tip), 0,
                        kLipEdgeRadius - depth * std::cos(tip) - radius * std::sin(tip));
  const double mean_gap = tip * radius * std::pow(std::pow(2, 2.5) * 16 / (15 * M_PI), 0.4);
  EXPECT_NEAR(lip.leakingGap(tipped) / mean_gap, std::cos(alpha), 5e-3);
}

}  // namespace
}  // namespace microinjection
