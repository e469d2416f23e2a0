#pragma once

#include <boost/math/interpolators/barycentric_rational.hpp>
#include <optional>
#include <string>

#include "cell/family/mouth_family_data.h"
#include "cell/surrogate/surrogate_data.h"

namespace microinjection {

/// What a needle on the axis feels of a cell that suction holds, over what it feels of the cell that is glued where the
/// lip touches it (Scene::glued()), as a function of the depth.
///
/// A ratio rather than a force: it is within a few percent of 1 for most cells, and smooth, so that few members know it
/// as well as the family of glued cells knows the force.
class HeldForce {
 public:
  /// @param log_ratios at the depths heldForceDepths(); `error`: relative, to be expected
  HeldForce(const Eigen::VectorXd& log_ratios, double error);

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
Eigen::VectorXd heldForceDepths();

/// Solves a member and its glued cell on meshes of one fineness, so that the ratio is more exact than its forces. Takes
/// some seconds. @throws std::runtime_error when there are too few equilibria
MouthMember solveHeldForce(const MouthFamily& family, const Eigen::VectorXd& coordinates);

/// Held forces of all cells of a family, made from solved ones.
class HeldForceFamily {
 public:
  /// @throws std::invalid_argument for data of another kind
  explicit HeldForceFamily(MouthFamilyData data);

  const MouthFamilyData& data() const { return data_; }
  /// @throws ConfigError as MouthFamilyData::predict()
  HeldForce force(const Eigen::VectorXd& coordinates) const;

 private:
  MouthFamilyData data_;
};

/// The held force of a scene by the first family in the folder `held` of a folder of families (empty: none) that has
/// it; nothing when none has: `reason` is one line for the user.
std::optional<HeldForce> findHeldForce(const std::string& families, const Scene& scene, std::string& reason);

}  // namespace microinjection
