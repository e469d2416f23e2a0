#include "cell/surrogate/energy_expansion.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "base/finite_difference.h"
#include "cell/surrogate/energy_fit.h"

namespace microinjection {
namespace {

constexpr double kMicro = 1e-6;

EnergyExpansion some() {
  EnergyExpansion expansion({}, {});
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  expansion.setCoefficients(Eigen::VectorXd::NullaryExpr(expansion.size(), [&] { return normal(random); }));
  return expansion;
}

/// Displacements in the range.
std::vector<Eigen::Vector3d> displacements() {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> lateral(-4, 4), depth(0.2, 20);
  std::vector<Eigen::Vector3d> result;
  for (int i = 0; i < 30; ++i)
    result.push_back(kMicro * Eigen::Vector3d(lateral(random), lateral(random), -depth(random)));
  return result;
}

TEST(EnergyExpansion, DerivativesAreThoseOfTheEnergy) {
  const EnergyExpansion expansion = some();
  EnergyExpansion::Local local;
  for (double angle : {0.0, 0.3, 1.0}) {
    expansion.makeLocal(angle, local);
    for (const Eigen::Vector3d& u : displacements()) {
      const Jet at = local.evaluate(u);
      const auto energy = [&](const Eigen::VectorXd& x) {
        return Eigen::VectorXd(Eigen::VectorXd::Constant(1, local.evaluate(kMicro * x).value));
      };
      const auto gradient = [&](const Eigen::VectorXd& x) {
        return Eigen::VectorXd(local.evaluate(kMicro * x).gradient);
      };
      EXPECT_LT(derivativeError(energy, u / kMicro, kMicro * at.gradient.transpose(), 1e-4), 1e-5);
      EXPECT_LT(derivativeError(gradient, u / kMicro, kMicro * at.hessian, 1e-4), 1e-5);
    }
  }
}

TEST(EnergyExpansion, TheBasisIsWhatIsEvaluated) {
  const EnergyExpansion expansion = some();
  EnergyExpansion::Local local;
  expansion.makeLocal(0.7, local);
  Eigen::VectorXd energy;
  Eigen::Matrix3Xd gradient;
  for (const Eigen::Vector3d& u : displacements()) {
    expansion.basis(0.7, u, energy, gradient);
    const Jet at = local.evaluate(u);
    EXPECT_NEAR(energy.dot(expansion.coefficients()) / at.value, 1, 1e-9);
    EXPECT_LT((gradient * expansion.coefficients() - at.gradient).norm(), 1e-9 * at.gradient.norm());
  }
}

/// On the axis no direction is special, and nowhere is a side.
TEST(EnergyExpansion, HasTheSymmetryOfTheCell) {
  const EnergyExpansion expansion = some();
  EnergyExpansion::Local pole, beside;
  expansion.makeLocal(0, pole);
  expansion.makeLocal(0.5, beside);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (const Eigen::Vector3d& u : displacements()) {
    EXPECT_NEAR(pole.evaluate(turn * u).value / pole.evaluate(u).value, 1, 1e-9);
    EXPECT_NEAR(beside.evaluate({u.x(), -u.y(), u.z()}).value / beside.evaluate(u).value, 1, 1e-9);
    EXPECT_GT(std::abs(beside.evaluate(turn * u).value / beside.evaluate(u).value - 1), 1e-6);
  }
}

/// Along closed paths the force does no work, whatever the coefficients are.
TEST(EnergyExpansion, ClosedPathsCreateNoEnergy) {
  const EnergyExpansion expansion = some();
  EnergyExpansion::Local local;
  expansion.makeLocal(0.6, local);
  const auto corners = displacements();
  const double nodes[3] = {-std::sqrt(0.6), 0, std::sqrt(0.6)}, weights[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
  double work = 0, path = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d from = corners[i], step = corners[(i + 1) % corners.size()] - from;
    constexpr int kPieces = 4000;
    for (int k = 0; k < kPieces; ++k) {
      for (int q = 0; q < 3; ++q) {
        const Eigen::Vector3d force = -local.evaluate(from + (k + 0.5 + 0.5 * nodes[q]) / kPieces * step).gradient;
        const double part = 0.5 * weights[q] / kPieces * force.dot(step);
        work += part;
        path += std::abs(part);
      }
    }
  }
  EXPECT_LT(std::abs(work), 1e-9 * path);
}

TEST(EnergyExpansion, NothingAtNoDisplacement) {
  const EnergyExpansion expansion = some();
  EnergyExpansion::Local local;
  expansion.makeLocal(0.2, local);
  EXPECT_EQ(local.evaluate(Eigen::Vector3d::Zero()).value, 0);
  EXPECT_TRUE(local.evaluate(Eigen::Vector3d::Zero()).gradient.isZero(0));
  EXPECT_TRUE(EnergyExpansion::Local().evaluate({0, 0, -1e-6}).gradient.isZero(0));
}

/// A contact of Hertz on a curved cell, with a lateral spring that stiffens with depth: not of the expansion's form.
TrainingSample hertz(double angle, const Eigen::Vector3d& u) {
  const double tilt = std::sin(angle), depth = -u.z() * std::cos(angle) - tilt * u.x();
  TrainingSample sample{angle, u, Eigen::Vector3d::Zero(), {}};
  if (depth <= 0) return sample;
  const double normal = 2.5 * std::pow(depth, 1.5);
  const Eigen::Vector2d side(u.x() * std::cos(angle) - u.z() * -tilt, u.y());
  const Eigen::Vector2d drag = 0.8 * std::sqrt(depth) * side;
  const Eigen::Vector3d along(std::cos(angle), 0, tilt), inwards(-tilt, 0, -std::cos(angle));
  const double more = 0.2 / std::sqrt(depth) * side.squaredNorm();  // d/d(depth) of 0.4 sqrt(depth) |side|^2
  sample.force = -((normal + more) * inwards + drag.x() * along + drag.y() * Eigen::Vector3d::UnitY());
  return sample;
}

TEST(EnergyFit, FindsAnEnergyBetweenItsRays) {
  EnergyScales scales;
  scales.length = 1;
  scales.energy = 1;
  EnergyExpansion expansion(scales, {6, 6, 7});
  std::vector<TrainingSample> samples, unseen;
  for (double angle : {0.0, 0.26, 0.52, 0.79, 1.05}) {
    for (double tilt : {0.0, 0.4, 0.8, 1.0}) {
      for (double turn : {0.0, 0.8, 1.6, 2.4, 3.14}) {
        for (int i = 1; i <= 12; ++i) {
          const double t = i * i / 144.0;
          const Eigen::Vector3d way(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), -std::cos(tilt));
          samples.push_back(hertz(angle, t * way));
        }
      }
    }
  }
  samples.erase(std::remove_if(samples.begin(), samples.end(), [](const auto& s) { return s.force.isZero(0); }),
                samples.end());
  for (double angle : {0.15, 0.6}) {
    for (double x : {-0.3, 0.1, 0.2}) unseen.push_back(hertz(angle, {x, 0.15, -0.6}));
  }
  fitEnergy(expansion, samples);
  for (const TrainingSample& sample : unseen) {
    EnergyExpansion::Local local;
    expansion.makeLocal(sample.angle, local);
    const Eigen::Vector3d force = -local.evaluate(sample.displacement).gradient;
    EXPECT_LT((force - sample.force).norm(), 0.02 * sample.force.norm());
  }
}

}  // namespace
}  // namespace microinjection
