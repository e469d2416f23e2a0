#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "cell/surrogate/spring_cells.h"
#include "cell/surrogate/surrogate_contact.h"

namespace microinjection {
namespace {

/// In, about, out of the range and of the contact, and back to the start: what the needle got back it had put in.
TEST(SurrogateContactEnergy, ClosedPathsCreateNoEnergy) {
  const Scene scene = pipette();
  const auto rough = springs(scene);
  Eigen::VectorXd coefficients = rough->energy.coefficients();
  for (Eigen::Index i = 1; i < coefficients.size(); ++i)
    coefficients[i] = 0.02 * std::sin(7.0 * static_cast<double>(i));
  rough->energy.setCoefficients(coefficients);
  for (const auto& cell : {rough, fieldOfSprings(scene, 0.3), fieldOfSprings(scene, -0.3)}) {
    SurrogateContact contact(scene, cell);
    for (unsigned seed = 1; seed <= 20; ++seed) {
      std::srand(seed);
      Eigen::Vector3d tip(0, 0, 29e-6), force = Eigen::Vector3d::Zero();
      double work = 0, all = 0;
      const auto go = [&](const Eigen::Vector3d& target) {
        const int steps = 4000;
        const Eigen::Vector3d move = (target - tip) / steps;
        for (int i = 0; i < steps; ++i) {
          tip += move;
          const Eigen::Vector3d now = contact.step(tip).force;
          work += 0.5 * (force + now).dot(move);
          all += std::abs(0.5 * (force + now).dot(move));
          force = now;
        }
      };
      for (int leg = 0; leg < 6; ++leg) {
        const Eigen::Vector3d target = Eigen::Vector3d::Random();
        go({15e-6 + 6e-6 * target.x(), 6e-6 * target.y(), 16e-6 + 14e-6 * target.z()});
      }
      go({15e-6, 0, 34e-6});
      EXPECT_LT(work, 1e-4 * all) << "seed " << seed;
    }
  }
}

/// What a field that is no gradient would give for nothing: the same loop again and again.
TEST(SurrogateContactEnergy, ALoopIsNoEngine) {
  const Scene scene = pipette();
  for (const double more : {0.3, -0.3}) {
    for (const double sense : {1.0, -1.0}) {
      SurrogateContact contact(scene, fieldOfSprings(scene, more));
      contact.step({0, 0, 27.99e-6});
      double work = 0, round = 0;
      Eigen::Vector3d tip(0, 0, 20e-6), force = contact.step(tip).force;
      for (int i = 1; i <= 40000; ++i) {
        const double turn = sense * 2 * 3.14159265358979 * i / 1000;
        const Eigen::Vector3d next(2e-6 * std::sin(turn), 0, 22e-6 - 2e-6 * std::cos(turn)),
            now = contact.step(next).force;
        work += 0.5 * (force + now).dot(next - tip);
        if (i > 20000) round += 0.5 * (force + now).dot(next - tip);
        tip = next;
        force = now;
      }
      EXPECT_LT(round, 1e-4 * std::abs(force.z()) * 4e-6);
    }
  }
}

}  // namespace
}  // namespace microinjection
