#include "base/finite_difference.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

Eigen::VectorXd function(const Eigen::VectorXd& x) { return Eigen::Vector2d(std::sin(x[0]) * x[1], x[1] * x[1]); }

Eigen::MatrixXd derivative(const Eigen::VectorXd& x) {
  Eigen::MatrixXd result(2, 2);
  result << std::cos(x[0]) * x[1], std::sin(x[0]), 0, 2 * x[1];
  return result;
}

const Eigen::Vector2d kPoint(0.7, -1.3);

TEST(FiniteDifference, PassesARightDerivative) {
  EXPECT_LT(derivativeError(function, kPoint, derivative(kPoint), 1e-5), 1e-9);
}

TEST(FiniteDifference, FailsAWrongDerivative) {
  for (Eigen::Index i = 0; i < 4; ++i) {
    Eigen::MatrixXd wrong = derivative(kPoint);
    wrong(i) += 0.01;
    EXPECT_GT(derivativeError(function, kPoint, wrong, 1e-5), 1e-3) << "entry " << i;
  }
  EXPECT_GT(derivativeError(function, kPoint, -derivative(kPoint), 1e-5), 1);
  EXPECT_GT(derivativeError(function, kPoint, Eigen::MatrixXd::Zero(2, 2), 1e-5), 0.5);
}

TEST(FiniteDifference, IsZeroForAConstant) {
  const auto constant = [](const Eigen::VectorXd&) { return Eigen::VectorXd(Eigen::Vector2d(1, 2)); };
  EXPECT_EQ(derivativeError(constant, kPoint, Eigen::MatrixXd::Zero(2, 2), 1e-5), 0);
}

}  // namespace
}  // namespace microinjection
