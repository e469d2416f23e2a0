#include "cell/mechanics/explicit_step.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>

#include "base/errors.h"
#include "cell/mechanics/bodies.h"
#include "cell/mechanics/load_path.h"
#include "cell/mechanics/tetrahedra.h"

namespace microinjection {
namespace {

constexpr double kBlockYoung = 2, kBlockPoisson = 0.3;

/// The block, held below and pushed from above.
ExplicitStepConfig pressedBlock(const TetMesh& mesh) {
  ExplicitStepConfig config;
  config.lame = Lame::from(kBlockYoung, kBlockPoisson);
  config.density = kDensity;
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v) {
    if (mesh.vertices[v].z() == 0) config.held.push_back(v);
    if (mesh.vertices[v].z() == 1) config.tip.push_back(v);
  }
  return config;
}

std::shared_ptr<LayeredBody<3>> body() {
  return makeBody(irregularBlock<3>(3), ElementKind::kP1, "st_venant_kirchhoff", kBlockPoisson);
}

TEST(ExplicitStep, HighestFrequencyIsThatOfTheStiffness) {
  const TetMesh mesh = linearMesh(irregularBlock<3>(3));
  ExplicitStepConfig config = pressedBlock(mesh);
  const int count = static_cast<int>(mesh.vertices.size());
  std::vector<double> masses(count, 0);
  double whole = 0;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const double mass = kDensity * tetrahedronVolume(mesh, static_cast<int>(t));
    for (int vertex : mesh.tetrahedra[t]) masses[vertex] += mass / 4;
    whole += mass;
  }
  ASSERT_NEAR(whole, kDensity, 1e-12);
  const auto elements = body();
  Eigen::MatrixXd matrix = hessianOf(*elements, Eigen::VectorXd::Zero(elements->stateSize()));
  matrix.conservativeResize(3 * count, 3 * count);
  for (int i = 0; i < 3 * count; ++i) {
    const double z = mesh.vertices[i / 3].z(), scale = z == 0 || z == 1 ? 0 : 1 / std::sqrt(masses[i / 3]);
    matrix.row(i) *= scale;
    matrix.col(i) *= scale;
  }
  const double expected = std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues().maxCoeff());
  config.safety = 0.7;
  const ExplicitStep dynamics(mesh, config);
  EXPECT_NEAR(dynamics.highestFrequency(), expected, 1e-3 * expected);
  EXPECT_NEAR(dynamics.timeStep(), 0.7 * 2 / expected, 1e-3 * dynamics.timeStep());
}

TEST(ExplicitStep, ComesToRestAtTheQuasiStaticSolution) {
  const TetMesh mesh = linearMesh(irregularBlock<3>(3));
  const Eigen::Vector3d push(0.05, 0.02, -0.15);
  const auto elements = body();
  Constraints constraints = freeBody(*elements);
  hold(
      *elements, [](const Eigen::Vector3d& x) { return x.z() == 0; }, constraints);
  stick(
      *elements, [](const Eigen::Vector3d& x) { return x.z() == 1; }, constraints);
  EquilibriumSystem system({elements}, constraints, SymmetricSolver::Method::kSimplicial);
  LoadPathConfig path_config;
  path_config.length = path_config.first_step = path_config.largest_step = 1;
  path_config.smallest_step = 1e-5;
  LoadPath path(system, path_config);
  ASSERT_TRUE(path.advance(push).converged);

  ExplicitStepConfig config = pressedBlock(mesh);
  config.damping = 2;
  ExplicitStep dynamics(mesh, config);
  for (int i = 0; i < 1000; ++i) dynamics.step(push * std::min(1.0, i / 100.0));
  EXPECT_LT(dynamics.kineticEnergy(), 1e-16);
  const Eigen::Vector3d expected = -path.reaction();
  EXPECT_GT(expected.z(), 0.1);
  EXPECT_LT((dynamics.force() - expected).norm(), 1e-6 * expected.norm());
  const Eigen::Map<const Eigen::VectorXd> found(dynamics.positions().data(), 3 * mesh.vertices.size());
  EXPECT_LT((found - places(mesh) - path.state().head(found.size())).cwiseAbs().maxCoeff(), 1e-6);
}

/// Positions after a smooth push and some ringing.
Eigen::VectorXd after(const TetMesh& mesh, double safety, int steps) {
  ExplicitStepConfig config = pressedBlock(mesh);
  config.safety = safety;
  config.damping = 0.5;
  ExplicitStep dynamics(mesh, config);
  for (int i = 1; i <= steps; ++i) {
    const double share = std::min(1.0, 2.0 * i / steps);
    dynamics.step(Eigen::Vector3d(0.02, 0, -0.1) * share * share * share * (10 - 15 * share + 6 * share * share));
  }
  return Eigen::Map<const Eigen::VectorXd>(dynamics.positions().data(), 3 * mesh.vertices.size());
}

TEST(ExplicitStep, IsOfSecondOrderInTime) {
  const TetMesh mesh = linearMesh(irregularBlock<3>(3));
  const Eigen::VectorXd coarse = after(mesh, 0.4, 60), middle = after(mesh, 0.2, 120), fine = after(mesh, 0.1, 240);
  const double ratio = (coarse - middle).norm() / (middle - fine).norm();
  EXPECT_GT((coarse - middle).norm(), 1e-9);
  EXPECT_GT(ratio, 3.4);
  EXPECT_LT(ratio, 4.6);
}

TEST(ExplicitStep, StaysBoundedAtItsLimit) {
  const TetMesh mesh = linearMesh(irregularBlock<3>(3));
  ExplicitStepConfig config = pressedBlock(mesh);
  config.safety = 0.98;
  ExplicitStep dynamics(mesh, config);
  const Eigen::Vector3d push(0, 0, -1e-4);
  for (int i = 0; i < 20000; ++i) dynamics.step(push);  // a jump rings for ever
  const double amplitude =
      (Eigen::Map<const Eigen::VectorXd>(dynamics.positions().data(), 3 * mesh.vertices.size()) - places(mesh))
          .cwiseAbs()
          .maxCoeff();
  EXPECT_LT(amplitude, 5e-4);
  EXPECT_GT(dynamics.kineticEnergy(), 0);
}

TEST(ExplicitStep, TensorsMoveItAsTheKernelDoes) {
  const TetMesh mesh = linearMesh(irregularBlock<3>(3));
  using Force = ExplicitStepConfig::Force;
  std::vector<std::vector<double>> found;
  for (const Force force : {Force::kKernel, Force::kTensors, Force::kLinearTensors}) {
    ExplicitStepConfig config = pressedBlock(mesh);
    config.force = force;
    config.time_step = 0.01;
    ExplicitStep dynamics(mesh, config);
    EXPECT_EQ(dynamics.timeStep(), 0.01);
    for (int i = 1; i <= 100; ++i) dynamics.step({0, 0, -0.001 * i});
    found.push_back(dynamics.positions());
  }
  double nonlinear = 0;
  for (std::size_t i = 0; i < found[0].size(); ++i) {
    EXPECT_NEAR(found[1][i], found[0][i], 1e-12);
    nonlinear = std::max(nonlinear, std::abs(found[2][i] - found[0][i]));
  }
  EXPECT_GT(nonlinear, 1e-4);
}

TEST(ExplicitStep, RefusesBadConfigurations) {
  const TetMesh mesh = linearMesh(irregularBlock<3>(2));
  ExplicitStepConfig config = pressedBlock(mesh);
  config.tip.push_back(config.held.front());
  config.held.push_back(99);
  config.density = 0;
  config.damping = -1;
  config.safety = 1.5;
  config.time_step = 0;
  try {
    ExplicitStep(mesh, config).timeStep();
    FAIL();
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    for (const char* part :
         {"density = 0", "damping = -1", "safety = 1.5", "time_step = 0", "held: vertex 99", "tip: vertex 0"}) {
      EXPECT_NE(text.find(part), std::string::npos) << text;
    }
  }
  TetMesh loose = mesh;
  loose.vertices.emplace_back(3, 3, 3);
  EXPECT_THROW(ExplicitStep(loose, pressedBlock(mesh)), std::invalid_argument);
}

}  // namespace
}  // namespace microinjection
