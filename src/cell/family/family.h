#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "cell/family/ratio.h"
#include "cell/model/scene.h"
#include "cell/surrogate/preparation.h"

namespace microinjection {

/// Cells under a tip that differ in a few ratios only (config/families/*.yaml), without dimension.
class Family {
 public:
  /// A ratio and its borders. One that does not vary is that of the family's scene; cells within its
  /// borders are served as if they had that.
  struct Parameter {
    const Ratio* ratio = nullptr;
    double low = 0, high = 0;

    double coordinate(double value) const;  ///< -1 at low, 1 at high
    double value(double coordinate) const;
    std::string text(double value) const;  ///< "tip_radius 0.107 of [0.04, 0.2]"
  };

  /// Throws ConfigError that names file, key, value and what is allowed.
  static Family load(const std::string& path);

  const std::string& name() const { return name_; }
  const std::vector<Parameter>& parameters() const { return parameters_; }
  int dimension() const { return static_cast<int>(parameters_.size()); }

  /// The member at these coordinates, without dimension.
  Scene member(const Eigen::VectorXd& coordinates) const;
  /// Coordinates of a scene; outside of [-1, 1] beyond the borders. Nothing when the scene differs
  /// from the family in something else; `misfit` then says in what, for the user.
  std::optional<Eigen::VectorXd> coordinatesOf(const Scene& scene, std::string* misfit = nullptr) const;
  /// Whether all coordinates are within the borders, up to rounding.
  static bool contains(const Eigen::VectorXd& coordinates);

  /// The range of a member's preparation: `angle` and
  ///     depth = deepest / (1 + (tip of half the depth / tip radius)^2.5),
  /// because paths of a thin tip end earlier; see familyRange.
  PreparationRange range(const Scene& member) const;

  /// One line with everything that the data of the family depend on.
  std::string description() const;

 private:
  std::optional<double> takeRatio(const Ratio& ratio, Scene& scene) const;
  std::optional<Eigen::VectorXd> coordinatesOf(const Scene& scene, std::string& misfit) const;
  std::string differenceFrom(const Scene& scene) const;

  std::string name_;
  Scene scene_;
  std::vector<Parameter> parameters_, constants_;
  double angle_ = 0, deepest_ = 0, half_depth_tip_ = 0;
};

}  // namespace microinjection
