#include "vision/calibration/statistics.h"

#include <gtest/gtest.h>

#include <limits>

namespace microinjection {
namespace {

// Limits from printed tables of the distributions.
TEST(Statistics, LimitsAreThoseOfTheTables) {
  EXPECT_NEAR(studentLimit(0.95, 10), 2.2281, 1e-4);
  EXPECT_NEAR(studentLimit(0.95, 1), 12.706, 1e-3);
  EXPECT_NEAR(fisherLimit(0.95, 2, 10), 4.1028, 1e-4);
}

TEST(Statistics, MedianAndDeviationAreNotMovedByOutliers) {
  EXPECT_EQ(medianOf({5}), 5);
  EXPECT_EQ(medianOf({4, 1, 3, 2}), 2.5);
  EXPECT_NEAR(robustDeviation({1, 2, 3, 4, 1e9}), 1.4826, 1e-12);
}

TEST(Statistics, ACovarianceIsFiniteSymmetricAndPositive) {
  Eigen::Matrix2d matrix;
  matrix << 2, 1, 1, 2;
  EXPECT_TRUE(isCovariance(matrix));
  EXPECT_FALSE(isCovariance(Eigen::Matrix2d::Zero()));
  matrix(0, 1) = 0;
  EXPECT_FALSE(isCovariance(matrix));
  matrix << 1, 2, 2, 1;
  EXPECT_FALSE(isCovariance(matrix));
  matrix << std::numeric_limits<double>::quiet_NaN(), 0, 0, 1;
  EXPECT_FALSE(isCovariance(matrix));
}

}  // namespace
}  // namespace microinjection
