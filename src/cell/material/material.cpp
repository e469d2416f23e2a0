#include "cell/material/material.h"

#include <algorithm>
#include <cmath>

#include "cell/material/second_derivatives.h"

namespace microinjection {

namespace {

/// The energy without this penalty must stay stable, or a mixed element is not stable: its bulk
/// modulus must not be negative.
double mixedModulus(double lambda, const Lame& lame) {
  const double bulk = lame.lambda + 2 * lame.mu / 3;
  return std::max(lambda, std::min(lame.mu, 0.5 * bulk));
}

}  // namespace

Material::Material(double lambda, const Lame& lame)
    : kappa_(mixedModulus(lambda, lame)), lambda_excess_(lambda - kappa_) {}

double Material::energyDensity(const Kinematics& kinematics, const Weights& weights) const {
  const double energy = modelEnergy(kinematics);
  if (std::isinf(energy)) return energy;  // g is infinite, too
  const double g = kinematics.dilatation, modulus = weights.modulus + weights.distortional * lambda_excess_;
  return weights.distortional * energy + (weights.pressure + 0.5 * modulus * g) * g;
}

Eigen::Matrix3d Material::stress(const Kinematics& kinematics, const Weights& weights) const {
  const double modulus = weights.modulus + weights.distortional * lambda_excess_;
  const double pressure = weights.pressure + modulus * kinematics.dilatation;
  return weights.distortional * modelStress(kinematics) + pressure * kinematics.dilatation_gradient;
}

Material::Matrix9d Material::tangent(const Kinematics& kinematics, const Weights& weights) const {
  const double modulus = weights.modulus + weights.distortional * lambda_excess_;
  const double pressure = weights.pressure + modulus * kinematics.dilatation;
  Matrix9d result;
  if (modulus == 0) {
    result.setZero();
  } else {
    const auto gradient = flat(kinematics.dilatation_gradient);
    result.noalias() = (modulus * gradient).lazyProduct(gradient.transpose());
  }
  addModelTangent(kinematics, weights.distortional, pressure, result);
  return result;
}

}  // namespace microinjection
