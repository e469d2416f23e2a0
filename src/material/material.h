#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

namespace microinjection {

/// Hyperelastic material: everything is a function of the deformation gradient F = dx/dX.
class Material {
 public:
  using Matrix9d = Eigen::Matrix<double, 9, 9>;

  virtual ~Material() = default;

  /// Strain energy per undeformed volume, J/m^3; zero when undeformed, +infinity where it is not defined (det F <= 0
  /// of a material that resists being crushed to nothing).
  virtual double energyDensity(const Eigen::Matrix3d& F) const = 0;

  /// First Piola-Kirchhoff stress P = dW/dF, Pa. @pre energyDensity(F) is finite.
  virtual Eigen::Matrix3d stress(const Eigen::Matrix3d& F) const = 0;

  /// dP/dF, Pa: row and column i + 3 J stand for component (i, J), the column-major order of Eigen; symmetric.
  /// @pre energyDensity(F) is finite.
  virtual Matrix9d tangent(const Eigen::Matrix3d& F) const = 0;

  /// The stress is a linear function of the displacement gradient: small strain, one solution at any load, and no
  /// meaning in det F.
  virtual bool isLinear() const { return false; }
};

/// Which material, and its two elastic constants.
struct MaterialConfig {
  std::string model = "neo_hookean";  ///< one of materialModels()
  double young_modulus = 17.9e3;      ///< Pa, > 0
  double poisson_ratio = 0.49;        ///< in (-1, 0.5)

  /// Throws ConfigError with all errors at once.
  void validate() const;
};

/// linear, st_venant_kirchhoff, neo_hookean.
const std::vector<std::string>& materialModels();

/// Throws ConfigError when the configuration is not valid.
std::unique_ptr<Material> makeMaterial(const MaterialConfig& config);

}  // namespace microinjection
