#include "cell/family/chebyshev_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace microinjection {
namespace {

double function(const Eigen::VectorXd& x) { return std::exp(0.5 * x[0] - 0.3 * x[1] * x[0]) + std::sin(x[2]); }

double interpolationError(int points) {
  const ChebyshevGrid grid(3, points);
  Eigen::VectorXd values(grid.size());
  for (int i = 0; i < grid.size(); ++i) values[i] = function(grid.node(i));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  double largest = 0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d x(uniform(random), uniform(random), uniform(random));
    largest = std::max(largest, std::abs(grid.interpolate(values, x) - function(x)));
  }
  return largest;
}

TEST(ChebyshevGrid, HasTheValuesOfItsNodesAndTheBorders) {
  const ChebyshevGrid grid(2, 4);
  ASSERT_EQ(grid.size(), 16);
  EXPECT_EQ(grid.node(0), Eigen::Vector2d(-1, -1));
  EXPECT_EQ(grid.node(15), Eigen::Vector2d(1, 1));
  const Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(16, 3, 5);
  for (int i = 0; i < 16; ++i) EXPECT_NEAR(grid.interpolate(values, grid.node(i)), values[i], 1e-14);
}

TEST(ChebyshevGrid, ConvergesExponentially) {
  EXPECT_LT(interpolationError(4), 0.02);
  EXPECT_LT(interpolationError(6), 0.02 * interpolationError(4));
  EXPECT_LT(interpolationError(10), 1e-3 * interpolationError(6));
}

}  // namespace
}  // namespace microinjection
