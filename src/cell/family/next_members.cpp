#include "cell/family/next_members.h"

#include <cmath>

#include "cell/family/kriging.h"

namespace microinjection {
namespace {

constexpr int kSteps = 8;            ///< of the candidates in each coordinate
constexpr double kEqual = 1 - 1e-9;  ///< a candidate must be better than that, so that rounding chooses none

/// All points of the grid, a column each; the centre first.
Eigen::MatrixXd candidates(Eigen::Index dimension) {
  const auto count = static_cast<Eigen::Index>(std::lround(std::pow(kSteps + 1, dimension)));
  Eigen::MatrixXd points(dimension, count + 1);
  points.col(0).setZero();
  for (Eigen::Index i = 0; i < count; ++i) {
    Eigen::Index rest = i;
    for (Eigen::Index k = 0; k < dimension; ++k, rest /= kSteps + 1) {
      points(k, i + 1) = 2.0 * static_cast<double>(rest % (kSteps + 1)) / kSteps - 1;
    }
  }
  return points;
}

}  // namespace

std::vector<Eigen::VectorXd> nextMembers(const Eigen::MatrixXd& known, const Eigen::VectorXd& lengths, int count) {
  const Eigen::MatrixXd all = candidates(lengths.size());
  Eigen::MatrixXd points = known;
  std::vector<Eigen::VectorXd> result;
  for (int n = 0; n < count; ++n) {
    Eigen::Index best = 0;
    double largest = 0;
    if (points.cols() > 0) {
      const Kriging kriging(points, lengths, 0);
      for (Eigen::Index i = 0; i < all.cols(); ++i) {
        const double deviation = kriging.deviation(all.col(i));
        if (kEqual * deviation <= largest) continue;
        largest = deviation;
        best = i;
      }
    }
    result.emplace_back(all.col(best));
    points.conservativeResize(lengths.size(), points.cols() + 1);
    points.rightCols(1) = all.col(best);
  }
  return result;
}

}  // namespace microinjection
