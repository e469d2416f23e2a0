#include "cell/mechanics/largest_frequency.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

/// A chain of n masses m and springs k between two walls: w_j = 2 sqrt(k/m) sin(j pi / (2 (n + 1))).
TEST(LargestFrequency, IsThatOfAChain) {
  const int n = 12;
  const double k = 3e2, m = 2e-9;
  Eigen::SparseMatrix<double> lower(n, n);
  for (int i = 0; i < n; ++i) {
    lower.insert(i, i) = 2 * k;
    if (i + 1 < n) lower.insert(i + 1, i) = -k;
  }
  const double expected = 2 * std::sqrt(k / m) * std::sin(n * M_PI / (2 * (n + 1)));
  EXPECT_NEAR(largestFrequency(lower, Eigen::VectorXd::Constant(n, m)) / expected, 1, 1e-5);
}

/// Unequal masses: the light one swings by itself.
TEST(LargestFrequency, MassesCount) {
  Eigen::SparseMatrix<double> lower(2, 2);
  lower.insert(0, 0) = 4;
  lower.insert(1, 1) = 4;
  EXPECT_NEAR(largestFrequency(lower, Eigen::Vector2d(1, 0.01)), 20, 1e-6);
}

/// Of any map; it may be asymmetric, and nothing comes of nothing.
TEST(LargestEigenvalue, IsThatOfATriangle) {
  Eigen::Matrix2d matrix;
  matrix << 3, 1, 0, 2;
  const auto map = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return matrix * x; };
  EXPECT_NEAR(largestEigenvalue(map, Eigen::Vector2d(1, 1)), 3, 1e-6);
  EXPECT_EQ(largestEigenvalue(map, Eigen::Vector2d::Zero()), 0);
  EXPECT_GT(std::abs(largestEigenvalue(map, Eigen::Vector2d(1, 1), {1e-9, 1}) - 3), 0.1);
}

}  // namespace
}  // namespace microinjection
