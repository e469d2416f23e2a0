#pragma once

#include <gtest/gtest.h>

#include "base/finite_difference.h"
#include "cell/mechanics/energy_term.h"

namespace microinjection {

/// Gradient and Hessian of every `stride`th element that has an energy, against differences. `step`: m.
/// Returns the number of these elements.
inline int expectDerivatives(const EnergyTerm& term, const Eigen::VectorXd& state, double step, double tolerance,
                             int stride = 1) {
  int checked = 0;
  for (int element = 0; element < term.elementCount(); element += stride) {
    const std::vector<int>& entries = term.entries(element);
    const auto at = [&](const Eigen::VectorXd& x, Order order) {
      Eigen::VectorXd moved = state;
      for (std::size_t i = 0; i < entries.size(); ++i) moved[entries[i]] = x[i];
      LocalEnergy result;
      EXPECT_TRUE(term.evaluate(element, moved, order, result));
      return result;
    };
    Eigen::VectorXd x(entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i) x[i] = state[entries[i]];
    const LocalEnergy result = at(x, Order::kHessian);
    if (result.zero) continue;
    ++checked;
    const auto energy = [&](const Eigen::VectorXd& y) {
      return Eigen::VectorXd(Eigen::VectorXd::Constant(1, at(y, Order::kEnergy).energy));
    };
    const auto gradient = [&](const Eigen::VectorXd& y) { return at(y, Order::kGradient).gradient; };
    EXPECT_LT(derivativeError(energy, x, result.gradient.transpose(), step), tolerance) << "element " << element;
    EXPECT_LT(derivativeError(gradient, x, result.hessian, step), tolerance) << "element " << element;
    EXPECT_EQ(result.energy, energy(x)[0]);
    EXPECT_LE((result.hessian - result.hessian.transpose()).norm(), 1e-13 * result.hessian.norm());
  }
  return checked;
}

}  // namespace microinjection
