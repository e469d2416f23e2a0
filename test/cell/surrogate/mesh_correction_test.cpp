#include "cell/surrogate/mesh_correction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace microinjection {
namespace {

constexpr double kDegree = 0.017453292519943295;

EnergyScales scales() {
  EnergyScales result;
  result.angle = 60 * kDegree;
  result.length = 45e-6;
  return result;
}

/// What a coarse mesh could be wrong by.
double truth(double angle, const Eigen::Vector3d& u) {
  const double place = angle / scales().angle;
  return 1 - 0.02 * place * place + 0.015 * place * u.x() / u.norm() - 0.03 * std::exp(-u.norm() / 0.6e-6);
}

std::vector<TrainingSample> path(double angle, const Eigen::Vector3d& end, bool fine) {
  std::vector<TrainingSample> samples;
  for (int i = 1; i <= 10; ++i) {
    const Eigen::Vector3d u = 0.01 * i * i * end;
    samples.push_back({angle, u, -1e-2 * (fine ? truth(angle, u) : 1) * u, {}});
  }
  return samples;
}

TEST(MeshCorrection, IsFoundFromPathsInThePlaneAndHoldsBesideIt) {
  std::vector<std::vector<TrainingSample>> coarse, fine;
  for (double angle : {20 * kDegree, 40 * kDegree, 60 * kDegree}) {
    for (double side : {-5e-6, 0.0, 5e-6}) {
      coarse.push_back(path(angle, {side, 0, -12e-6}, false));
      fine.push_back(path(angle, {side, 0, -12e-6}, true));
    }
  }
  fine[2].resize(6);  // it may end earlier
  std::vector<MeshCorrection::Pair> pairs;
  for (std::size_t i = 0; i < coarse.size(); ++i) pairs.push_back({&coarse[i], &fine[i]});
  const MeshCorrection correction(scales(), pairs);
  double worst = 0, uncorrected = 0;
  for (double angle : {15 * kDegree, 50 * kDegree}) {
    for (double length : {0.4e-6, 2e-6, 10e-6}) {
      const Eigen::Vector3d u = length * Eigen::Vector3d(0.2, 0.3, -0.9).normalized();
      worst = std::max(worst, std::abs(correction.factor(angle, u) - truth(angle, u)));
      uncorrected = std::max(uncorrected, std::abs(1 - truth(angle, u)));
    }
  }
  EXPECT_LT(worst, 0.01);  // near the touch the truth is of another form
  EXPECT_GT(uncorrected, 0.025);
}

/// The fine mesh's where it went, else what the coarse one is wrong by is taken off.
TEST(MeshCorrection, ForcesAreTheFineOnesOrCorrected) {
  std::vector<TrainingRay> rays;
  std::vector<TrainingResult> results;
  const auto add = [&](double side, double across, bool fine) {
    const Eigen::Vector3d end(side, across, -12e-6);
    rays.push_back({0.5, end, 10, fine ? kFineLevel : kCoarseLevel});
    results.push_back({path(0.5, end, fine), ""});
    for (TrainingSample& sample : results.back().samples) sample.surface.setConstant(3, fine ? 2 : 1);
  };
  for (const double side : {-5e-6, 0.0, 5e-6}) {
    add(side, 0, false);
    add(side, 0, true);
  }
  add(1e-6, 4e-6, false);  // beside the plane
  results[3].samples.resize(6);
  const auto better = betterForces(scales(), rays, results);
  ASSERT_EQ(better.size(), rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays[i].level == kFineLevel) {
      EXPECT_TRUE(better[i].empty());
      continue;
    }
    ASSERT_EQ(better[i].size(), 10u);
    for (std::size_t k = 2; k < 10; ++k) {
      const TrainingSample& sample = better[i][k];
      const bool solved = i != 6 && (i != 2 || k < 6);
      const Eigen::Vector3d expected = -1e-2 * truth(0.5, sample.displacement) * sample.displacement;
      EXPECT_LT((sample.force - expected).norm(), (solved ? 1e-12 : 0.006) * expected.norm()) << i << ' ' << k;
      EXPECT_EQ(sample.surface[0], 1) << "of the coarse mesh";
    }
  }
}

TEST(MeshCorrection, WithoutPairsThereIsNone) {
  EXPECT_EQ(MeshCorrection(scales(), {}).factor(0.5, {1e-6, 0, -2e-6}), 1);
}

}  // namespace
}  // namespace microinjection
