#include "cell/family/next_members.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "cell/family/kriging.h"

namespace microinjection {
namespace {

const Eigen::Vector3d kEqualLengths(2, 2, 2);

double largestDeviation(const std::vector<Eigen::VectorXd>& members, Eigen::Index count) {
  Eigen::MatrixXd known(3, count);
  for (Eigen::Index i = 0; i < count; ++i) known.col(i) = members[static_cast<std::size_t>(i)];
  const Kriging kriging(known, kEqualLengths, 0);
  double largest = 0;
  for (const double x : {-1.0, -0.3, 0.4, 1.0}) {
    for (const double y : {-1.0, -0.1, 0.6, 1.0}) {
      for (const double z : {-1.0, 0.2, 1.0}) largest = std::max(largest, kriging.deviation(Eigen::Vector3d(x, y, z)));
    }
  }
  return largest;
}

TEST(NextMembers, BeginInTheMiddleAndMakeThePredictionMoreCertain) {
  const auto members = nextMembers(Eigen::MatrixXd(3, 0), kEqualLengths, 24);
  EXPECT_TRUE(members.front().isZero(0));
  EXPECT_LT(largestDeviation(members, 12), 0.5 * largestDeviation(members, 4));
  EXPECT_LT(largestDeviation(members, 24), 0.3 * largestDeviation(members, 12));
}

/// So that processes agree without talking to each other, and an interrupted run continues.
TEST(NextMembers, ContinueFromTheKnownOnes) {
  const auto members = nextMembers(Eigen::MatrixXd(3, 0), kEqualLengths, 12);
  Eigen::MatrixXd known(3, 8);
  for (Eigen::Index i = 0; i < 8; ++i) known.col(i) = members[static_cast<std::size_t>(i)];
  const auto rest = nextMembers(known, kEqualLengths, 4);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(rest[i], members[8 + i]);
}

}  // namespace
}  // namespace microinjection
