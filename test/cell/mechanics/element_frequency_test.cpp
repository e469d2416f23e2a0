#include "cell/mechanics/largest_frequency.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "cell/mechanics/bodies.h"
#include "cell/mechanics/explicit_step.h"
#include "cell/mechanics/tensor_mass_force.h"
#include "cell/mechanics/tetrahedra.h"

namespace microinjection {
namespace {

TEST(ElementFrequency, IsTheLargestEigenvalueOfTheElement) {
  const TetMesh mesh = linearMesh(irregularBlock<3>(2));
  for (const double poisson : {-0.9, -0.3, 0.0, 0.3, 0.49}) {
    const Lame lame = Lame::from(2, poisson);
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
      const TetrahedronTensors tensors(mesh, t, lame);
      Eigen::Matrix<double, 12, 12> K;
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) K.block<3, 3>(3 * i, 3 * j) = tensors.K(i, j);
      }
      const double largest = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues().maxCoeff();
      const double expected = std::sqrt(largest / (kDensity * tensors.volume / 4));
      EXPECT_NEAR(elementFrequency(mesh, t, lame, kDensity), expected, 1e-9 * expected);
    }
  }
}

TEST(FrequencyBound, IsThatOfTheMostRigidElementWhereverItIs) {
  const TetMesh mesh = linearMesh(irregularBlock<3>(3));
  const Lame lame = Lame::from(2, 0.45);
  std::vector<double> frequencies;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    frequencies.push_back(elementFrequency(mesh, t, lame, kDensity));
  }
  const double highest = *std::max_element(frequencies.begin(), frequencies.end());
  EXPECT_EQ(frequencyBound(mesh, lame, kDensity), highest);
  EXPECT_GT(highest, frequencies.front());
  EXPECT_GT(highest, frequencies.back());
}

/// The largest of |displacement| after many steps of this length, of the bound's 2 / w.
double largestAfter(const TetMesh& mesh, const ExplicitStepConfig& base, double share) {
  ExplicitStepConfig config = base;
  const double bound = frequencyBound(mesh, config.lame, config.density);
  config.time_step = share * 2 / bound;
  ExplicitStep dynamics(mesh, config);
  for (int i = 0; i < 3000; ++i) dynamics.step({0, 0, -1e-7});  // a jump rings for ever
  return (Eigen::Map<const Eigen::VectorXd>(dynamics.positions().data(), 3 * mesh.vertices.size()) - places(mesh))
      .cwiseAbs()
      .maxCoeff();
}

TEST(FrequencyBound, HoldsAndTheObservedLimitIsNotFarAboveIt) {
  const TetMesh mesh = linearMesh(irregularBlock<3>(3));
  ExplicitStepConfig config;
  config.lame = Lame::from(2, 0.45);
  config.density = kDensity;
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v) {
    if (mesh.vertices[v].z() == 0) config.held.push_back(v);
    if (mesh.vertices[v].z() == 1) config.tip.push_back(v);
  }
  const double exact = ExplicitStep(mesh, config).highestFrequency();
  const double bound = frequencyBound(mesh, config.lame, config.density), slack = bound / exact;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {  // of the most rigid element, wherever it comes
    EXPECT_LE(elementFrequency(mesh, t, config.lame, config.density), bound);
  }
  TetMesh reversed = mesh;
  std::reverse(reversed.tetrahedra.begin(), reversed.tetrahedra.end());
  EXPECT_EQ(frequencyBound(reversed, config.lame, config.density), bound);
  EXPECT_GT(slack, 1);
  EXPECT_LT(slack, 2);
  EXPECT_LT(largestAfter(mesh, config, 0.999), 1e-6);
  EXPECT_LT(largestAfter(mesh, config, 0.99 * slack), 1e-5);      // the true limit
  EXPECT_FALSE(largestAfter(mesh, config, 1.01 * slack) < 1e-3);  // it may have become nan
}

}  // namespace
}  // namespace microinjection
