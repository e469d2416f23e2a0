#pragma once

#include <boost/math/interpolators/barycentric_rational.hpp>
#include <optional>
#include <string>

#include "cell/family/section_family_data.h"
#include "cell/surrogate/surrogate_data.h"

namespace microinjection {

/// What a needle on the axis feels, over what it feels of a cell of Family, as a function of the depth: of a cell that
/// suction holds over one that is glued where the lip touches it (Scene::glued()), or of a needle that rubs over one
/// that sticks.
///
/// A ratio rather than a force: it is near 1 and smooth, so that few members know it as well as the other family knows
/// the force.
class AxisForceRatio {
 public:
  /// @param log_ratios at the depths axisRatioDepths(); `error`: relative, to be expected
  AxisForceRatio(const Eigen::VectorXd& log_ratios, double error);

  /// @param depth over the cell's radius; beyond the deepest known one the ratio stays
  double ratio(double depth) const;
  double largestChange() const { return largest_; }  ///< of |ratio - 1|
  double error() const { return error_; }            ///< one of ten forces has more

  /// Multiplies the force along every straight path with the ratio at its length. It is known on the axis only.
  void applyTo(SurrogateData& data, double radius) const;

 private:
  double largest_, error_;
  boost::math::barycentric_rational<double> curve_;  ///< over the root of the depth
};

/// Over the cell's radius, ascending, at which members are known.
Eigen::VectorXd axisRatioDepths();

/// Of a scene whose needle rubs, the same one that sticks.
Scene stuck(Scene scene);

/// Solves a member, and its glued cell or its tip that sticks, on meshes of one fineness, so that the ratio is more
/// exact than its forces. Takes some seconds. @throws std::runtime_error when there are too few equilibria
SectionMember solveAxisForceRatio(const SectionFamily& family, const Eigen::VectorXd& coordinates);

/// Ratios of all cells of a family, made from solved ones.
class AxisForceRatioFamily {
 public:
  /// @throws std::invalid_argument for data of another kind
  explicit AxisForceRatioFamily(SectionFamilyData data);

  const SectionFamilyData& data() const { return data_; }
  /// @throws ConfigError as SectionFamilyData::predict()
  AxisForceRatio force(const Eigen::VectorXd& coordinates) const;

 private:
  SectionFamilyData data_;
};

/// The ratio of a scene by the first family in the folder `held` of a folder of families (empty: none) that has it;
/// nothing when none has: `reason` is one line for the user.
std::optional<AxisForceRatio> findHeldForce(const std::string& families, const Scene& scene, std::string& reason);
/// The same in the folder `friction`.
std::optional<AxisForceRatio> findFrictionForce(const std::string& families, const Scene& scene, std::string& reason);

}  // namespace microinjection
