#include "cell/mechanics/cohesive_wall.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>

#include "cell/mechanics/term_derivatives.h"
#include "cell/mesh/pierced_section.h"

namespace microinjection {
namespace {

constexpr double kHole = 1.5e-6, kHoleLength = 12e-6, kToughness = 4e-3, kOpening = 0.3e-6;  // m, m, J/m^2, m

LayeredBody<2> piercedBall() {
  PiercedSectionConfig section;
  section.radii = {18e-6};
  section.hole_radius = kHole;
  section.hole_length = kHoleLength;
  MaterialConfig material;
  material.model = "neo_hookean";
  return {makePiercedSection(section), ElementKind::kP2P0, {std::shared_ptr<const Material>(makeMaterial(material))}};
}

class CohesiveWallTest : public testing::Test {
 protected:
  CohesiveWallTest() : body_(piercedBall()), wall_(body_, {kHole, kToughness, kOpening, 1e12}) {}

  Eigen::VectorXd openedBy(double opening) const {  // everywhere
    Eigen::VectorXd state = Eigen::VectorXd::Zero(body_.stateSize());
    for (int node = 0; node < body_.nodeCount(); ++node) state[2 * node] = opening;
    return state;
  }
  double energy(double opening) const {
    double sum = 0;
    LocalEnergy local;
    for (int i = 0; i < wall_.elementCount(); ++i) {
      EXPECT_TRUE(wall_.evaluate(i, openedBy(opening), Order::kEnergy, local));
      sum += local.energy;
    }
    return sum;
  }
  double traction(double opening) const {  // Pa
    double sum = 0;
    LocalEnergy local;
    for (int i = 0; i < wall_.elementCount(); ++i) {
      EXPECT_TRUE(wall_.evaluate(i, openedBy(opening), Order::kGradient, local));
      sum += local.gradient.sum();
    }
    return sum / kArea;
  }

  // The rim is on the sphere, a little below the pole.
  const double kArea = 2 * M_PI * kHole * (kHoleLength - 18e-6 + std::sqrt(18e-6 * 18e-6 - kHole * kHole));
  LayeredBody<2> body_;
  CohesiveWall wall_;
};

TEST_F(CohesiveWallTest, DerivativesAreThoseOfTheEnergy) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> entry(-0.5, 2);
  Eigen::VectorXd state = Eigen::VectorXd::NullaryExpr(body_.stateSize(), [&] { return kOpening * entry(generator); });
  EXPECT_GT(expectDerivatives(wall_, state, 1e-4 * kOpening, 1e-5), 10);
  wall_.accept(1.3 * state);
  EXPECT_GT(expectDerivatives(wall_, state, 1e-4 * kOpening, 1e-5), 10) << "on the way back";
}

TEST_F(CohesiveWallTest, SpendsItsToughnessAndIsStrongestAtItsOpening) {
  EXPECT_NEAR(energy(30 * kOpening), kToughness * kArea, 1e-9 * kToughness * kArea);
  const double strength = CohesiveWall::strength({kHole, kToughness, kOpening, 0});
  EXPECT_NEAR(traction(kOpening), strength, 1e-9 * strength);
  EXPECT_LT(traction(0.9 * kOpening), strength);
  EXPECT_LT(traction(1.1 * kOpening), strength);
  EXPECT_NEAR(traction(-0.1 * kOpening), -0.1 * kOpening * 1e12, 1e-3 * strength);
}

TEST_F(CohesiveWallTest, AWallThatHasOpenedDoesNotHeal) {
  const double opened = energy(2 * kOpening), last = traction(2 * kOpening);
  wall_.accept(openedBy(2 * kOpening));
  EXPECT_NEAR(energy(2 * kOpening), opened, 1e-12 * opened);
  EXPECT_NEAR(traction(kOpening), last / 2, 1e-9 * last);
  EXPECT_NEAR(opened - energy(0), last * kOpening * kArea, 1e-9 * opened) << "only the triangle comes back";
  wall_.reset();
  EXPECT_EQ(energy(0), 0);
}

TEST_F(CohesiveWallTest, RefusesABodyWithoutAWall) {
  EXPECT_THROW(CohesiveWall(body_, {2 * kHole, kToughness, kOpening, 0}), std::invalid_argument);
  EXPECT_THROW(CohesiveWall(body_, {kHole, kToughness, 0, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace microinjection
