#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "base/finite_difference.h"
#include "cell/material/material.h"

namespace microinjection {

constexpr double kYoung = 17.9e3;  // Pa

inline Eigen::VectorXd flatVector(const Eigen::Matrix3d& matrix) { return matrix.reshaped(); }
inline Eigen::Matrix3d square(const Eigen::VectorXd& vector) { return vector.reshaped(3, 3); }

/// Wd, J/m^3, and its derivative, Pa; derivatives of the dilatation g.
inline double distortionalEnergy(const Material& material, const Eigen::Matrix3d& F) {
  return material.energyDensity(material.kinematics(F), Material::distortional());
}
inline Eigen::Matrix3d distortionalStress(const Material& material, const Eigen::Matrix3d& F) {
  return material.stress(material.kinematics(F), Material::distortional());
}
inline Eigen::Matrix3d dilatationGradient(const Material& material, const Eigen::Matrix3d& F) {
  return material.kinematics(F).dilatation_gradient;
}
inline Material::Matrix9d dilatationHessian(const Material& material, const Eigen::Matrix3d& F) {
  return material.tangent(material.kinematics(F), Material::mixed(0, 1));
}

/// Deformations of some 20 % with det F > 0.
inline std::vector<Eigen::Matrix3d> deformations(int count = 20) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> entry(-0.2, 0.2);
  std::vector<Eigen::Matrix3d> result;
  for (int i = 0; i < count; ++i) {
    result.push_back(Eigen::Matrix3d::Identity() + Eigen::Matrix3d::NullaryExpr([&] { return entry(random); }));
  }
  return result;
}

/// As deformations(), turned inside out: det F < 0, away from reflections.
inline std::vector<Eigen::Matrix3d> inversions() {
  std::vector<Eigen::Matrix3d> result = deformations();
  for (Eigen::Matrix3d& F : result) F.col(2) *= -0.4;
  return result;
}

/// derivativeError of `gradient` at F as the derivative of the number energy(F).
template <typename Energy>
double gradientError(const Energy& energy, const Eigen::Matrix3d& F, const Eigen::Matrix3d& gradient) {
  const auto values = [&](const Eigen::VectorXd& x) {
    return Eigen::VectorXd(Eigen::VectorXd::Constant(1, energy(square(x))));
  };
  return derivativeError(values, flatVector(F), flatVector(gradient).transpose(), 1e-5);
}

/// derivativeError of `hessian` at F as the derivative of the matrix gradient(F).
template <typename Gradient>
double hessianError(const Gradient& gradient, const Eigen::Matrix3d& F, const Material::Matrix9d& hessian) {
  const auto values = [&](const Eigen::VectorXd& x) { return flatVector(gradient(square(x))); };
  return derivativeError(values, flatVector(F), hessian, 1e-5);
}

/// Every model at auxetic, ordinary and nearly incompressible Poisson's ratios.
class MaterialCases : public testing::TestWithParam<std::tuple<std::string, double>> {
 protected:
  MaterialConfig config() const { return {std::get<0>(GetParam()), kYoung, std::get<1>(GetParam())}; }

  const std::unique_ptr<Material> material_ = makeMaterial(config());
};

inline auto everyMaterial() {
  return testing::Combine(testing::ValuesIn(materialModels()), testing::Values(-0.3, 0.0, 0.3, 0.49, 0.4999));
}

/// For example corotated_nu_minus_3000, in 1/10000.
inline std::string caseName(const testing::TestParamInfo<MaterialCases::ParamType>& info) {
  const long nu = std::lround(1e4 * std::get<1>(info.param));
  return std::get<0>(info.param) + "_nu_" + (nu < 0 ? "minus_" : "") + std::to_string(std::abs(nu));
}

}  // namespace microinjection
