#include "cell/family/kriging.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

/// Points that fill the square, a column each.
Eigen::MatrixXd points(Eigen::Index count) {
  Eigen::MatrixXd result(2, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto n = static_cast<double>(i + 1);
    result.col(i) << 2 * std::fmod(0.7548776662466927 * n, 1) - 1, 2 * std::fmod(0.5698402909980532 * n, 1) - 1;
  }
  return result;
}

double smooth(const Eigen::VectorXd& x) { return std::exp(0.8 * x[0]) * std::cos(x[1]) + 0.3 * x[0] * x[1]; }

Eigen::VectorXd values(const Eigen::MatrixXd& at) {
  Eigen::VectorXd result(at.cols());
  for (Eigen::Index i = 0; i < at.cols(); ++i) result[i] = smooth(at.col(i));
  return result;
}

const Eigen::Vector2d kUnequalLengths(1.5, 2);

TEST(Kriging, ReturnsTheKnownValues) {
  const Eigen::MatrixXd known = points(12);
  const Kriging kriging(known, kUnequalLengths, 0);
  for (Eigen::Index i = 0; i < known.cols(); ++i) {
    EXPECT_NEAR(kriging.weights(known.col(i)).dot(values(known)), smooth(known.col(i)), 1e-6);
    EXPECT_NEAR(kriging.deviation(known.col(i)), 0, 1e-4);
  }
}

TEST(Kriging, IsExactForLinearFunctionsWhateverTheNoise) {
  const Eigen::MatrixXd known = points(9);
  const Kriging kriging(known, kUnequalLengths, 0.1);
  const Eigen::Vector2d slope(3, -2), at(0.3, -0.9);
  const Eigen::VectorXd linear = known.transpose() * slope + Eigen::VectorXd::Constant(9, 5);
  EXPECT_NEAR(kriging.weights(at).dot(linear), slope.dot(at) + 5, 1e-9);
  EXPECT_NEAR(kriging.weights(at).sum(), 1, 1e-9);
}

TEST(Kriging, ConvergesToASmoothFunction) {
  const Eigen::MatrixXd at = 0.9 * points(50);
  double last = 2;
  for (const Eigen::Index count : {6, 12, 24}) {
    const Eigen::MatrixXd known = points(count);
    const Kriging kriging(known, kUnequalLengths, 0);
    double error = 0;
    for (Eigen::Index i = 0; i < at.cols(); ++i) {
      error = std::max(error, std::abs(kriging.weights(at.col(i)).dot(values(known)) - smooth(at.col(i))));
    }
    EXPECT_LT(error, 0.3 * last) << count;
    last = error;
  }
  EXPECT_LT(last, 1e-2);
}

/// With two points in one coordinate only a constant drift is determined.
TEST(Kriging, OfFewPointsIsDefined) {
  const Kriging one(Eigen::MatrixXd::Zero(2, 1), kUnequalLengths, 0);
  EXPECT_NEAR(one.weights(Eigen::Vector2d(0.5, 0.5))[0], 1, 1e-9);
  const Kriging two(points(2), kUnequalLengths, 0);
  EXPECT_NEAR(two.weights(Eigen::Vector2d(0.5, 0.5)).sum(), 1, 1e-9);
}

TEST(Kriging, LeavesOneOutWithoutSolvingAnew) {
  const Eigen::MatrixXd known = points(10);
  const double noise = 1e-3;
  const Eigen::MatrixXd weights = Kriging(known, kUnequalLengths, noise).leaveOneOut();
  for (Eigen::Index i = 0; i < known.cols(); ++i) {
    Eigen::MatrixXd others(2, known.cols() - 1);
    others << known.leftCols(i), known.rightCols(known.cols() - i - 1);
    const double anew = Kriging(others, kUnequalLengths, noise).weights(known.col(i)).dot(values(others));
    EXPECT_NEAR(weights.row(i).dot(values(known)), anew, 1e-7);
    EXPECT_EQ(weights(i, i), 0);
  }
}

}  // namespace
}  // namespace microinjection
