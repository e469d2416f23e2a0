#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "cell/family/ratio.h"
#include "cell/model/scene.h"
#include "cell/surrogate/surrogate_plan.h"

namespace microinjection {

class ConfigReader;

/// Cells under a tip that differ in a few ratios only (config/families/*.yaml), without dimension. A preparation of
/// some minutes for each cell is too long when cells differ from one to the next; in a family the surrogate data of a
/// few members are solved, and those of any other cell are interpolated between them (FamilyData).
///
///     scene, SI --> elastic(), withoutDimension() --> its ratios --> coordinates
///                   radius 1, modulus 1               tip_radius,    -1: low, 1: high, of the ratio
///                                                     ...            or of its logarithm (Ratio)
///
/// Size and modulus are no coordinates, because every force is E R^2 f(ratios) (Similarity). All else that
/// describeCellAndTip() lists, such as material model, tip's shape and contact mode, has to be as in the family's
/// scene. `constants` are the exception: ratios that do not vary in the data, and may differ a little in a cell that is
/// served.
class Family {
 public:
  /// A ratio and its borders. One that does not vary is that of the family's scene; cells within its
  /// borders are served as if they had that.
  struct Parameter {
    const Ratio* ratio = nullptr;
    double low = 0, high = 0;

    double coordinate(double value) const;  ///< -1 at low, 1 at high; of the logarithm where Ratio::logarithmic
    double value(double coordinate) const;  ///< the inverse
    std::string text(double value) const;   ///< "tip_radius 0.107 of [0.04, 0.2]"
  };

  /// Throws ConfigError that names file, key, value and what is allowed, also where the family's scene cannot be
  /// prepared (SurrogatePlan::check).
  static Family load(const std::string& path);

  const std::string& name() const { return name_; }
  const std::vector<Parameter>& parameters() const { return parameters_; }
  int dimension() const { return static_cast<int>(parameters_.size()); }

  /// The member at these coordinates, without dimension.
  Scene member(const Eigen::VectorXd& coordinates) const;
  /// Coordinates of a scene; outside of [-1, 1] beyond the borders. Nothing when the scene differs
  /// from the family in something else; `misfit` then says in what, for the user: also in what no surrogate has
  /// (SurrogatePlan::check). Viscoelasticity that relaxes evenly is not compared.
  std::optional<Eigen::VectorXd> coordinatesOf(const Scene& scene, std::string* misfit = nullptr) const;
  /// Whether all coordinates are within the borders, up to rounding.
  static bool contains(const Eigen::VectorXd& coordinates);

  /// The range of a member's preparation: `angle` and
  ///     depth = deepest / (1 + (tip of half the depth / tip radius)^2.5),
  /// because paths of a thin tip end earlier; see familyRange.
  SurrogateRange range(const Scene& member) const;

  /// One line with everything that the data of the family depend on. Data with another line are not read, so the
  /// constants, which only say what else is served, are not in it.
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

/// Reads `key: {ratio: [low, high], ...}` of the ratios of `table`.
/// @param layers of the family's cells: a ratio of more is an error
std::vector<Family::Parameter> readFamilyParameters(ConfigReader& file, const std::string& key, int layers,
                                                    const std::vector<Ratio>& table);

}  // namespace microinjection
