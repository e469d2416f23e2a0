#include "cell/material/material.h"

#include <algorithm>
#include <cmath>

#include "base/config_errors.h"
#include "cell/material/material_models.h"
#include "cell/material/material_parameter.h"
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

const std::vector<std::string>& materialModels() {
  static const std::vector<std::string> models = [] {
    std::vector<std::string> names;
    for (const auto& [name, factory] : materialFactories()) names.emplace_back(name);
    return names;
  }();
  return models;
}

const std::vector<MaterialParameter>& materialParameters() {
  static const std::vector<MaterialParameter> parameters = {
      {"young_modulus", &MaterialConfig::young_modulus, Range::positive(), "Pa", "", 1},
      {"poisson_ratio", &MaterialConfig::poisson_ratio, Range::open(-1, 0.5), "", ""},
      {"mooney_ratio", &MaterialConfig::mooney_ratio, Range::closed(0, 1), "", "mooney_rivlin"},
      {"ogden_exponent", &MaterialConfig::ogden_exponent, Range::closed(1, 30), "", "ogden"},
      {"gent_limit", &MaterialConfig::gent_limit, Range::closed(0.1, 1e4), "", "gent"}};
  return parameters;
}

void MaterialConfig::validate() const {
  ConfigErrors errors("material");
  errors.requireOneOf(materialModels(), "model", model);
  for (const MaterialParameter& each : materialParameters())
    errors.require(each.allowed, each.name, this->*each.value, *each.unit == 0 ? "" : std::string(" ") + each.unit);
  viscoelasticity.check("viscoelasticity/", errors);
  errors.throwAny();
}

std::unique_ptr<Material> makeMaterial(const MaterialConfig& config) {
  config.validate();
  const Lame lame = Lame::from(config.young_modulus, config.poisson_ratio);
  for (const auto& [name, factory] : materialFactories()) {
    if (config.model == name) return factory(lame, config);
  }
  return nullptr;  // not reached: the configuration is valid
}

}  // namespace microinjection
