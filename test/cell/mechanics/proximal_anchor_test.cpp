#include "cell/mechanics/proximal_anchor.h"

#include <gtest/gtest.h>

#include "cell/mechanics/term_derivatives.h"

namespace microinjection {
namespace {

ProximalAnchor twoNodes() { return ProximalAnchor({{0, 1}, {2, 3}}, {0.25, 0.75}, 8); }

TEST(ProximalAnchor, DerivativesAreThoseOfTheEnergy) {
  const ProximalAnchor anchor = twoNodes();
  EXPECT_EQ(expectDerivatives(anchor, Eigen::VectorXd::LinSpaced(4, 1, 4), 1e-4, 1e-8), 2);
}

TEST(ProximalAnchor, ComesAfterTheBodyAndForgetsWhatWasNotAccepted) {
  ProximalAnchor anchor = twoNodes();
  const Eigen::VectorXd moved = Eigen::VectorXd::Ones(4);
  EXPECT_EQ(anchor.residualForce(moved), Eigen::VectorXd::Constant(2, -8));  // the springs' stiffness, all of it
  EXPECT_TRUE(anchor.settle(moved));
  EXPECT_EQ(anchor.residualForce(moved), Eigen::VectorXd::Zero(2));
  anchor.beginStep(1);  // the step is repeated
  EXPECT_EQ(anchor.residualForce(moved), Eigen::VectorXd::Constant(2, -8));
  anchor.settle(moved);
  anchor.accept(moved);
  anchor.beginStep(1);
  EXPECT_EQ(anchor.residualForce(moved), Eigen::VectorXd::Zero(2));
  anchor.reset();
  EXPECT_EQ(anchor.residualForce(moved), Eigen::VectorXd::Constant(2, -8));
}

}  // namespace
}  // namespace microinjection
