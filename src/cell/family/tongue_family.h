#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "cell/family/family.h"
#include "cell/model/scene.h"

namespace microinjection {

/// Cells in the mouth of a pipette that differ in a few ratios only (config/families/tongues/*.yaml), without
/// dimension: radius 1, modulus of the outermost layer 1. The needle does not touch the cell, so that the tongue, the
/// seal and the surface depend on the ratios and on the suction alone:
///
///     length / R = f(suction / E; bore_radius, lip_edge, wall, ...)
///
/// Beside Family rather than a kind of it, because nothing of a needle (paths, range, contact point) has a meaning
/// here. The suction is no coordinate: each member has a whole curve (TongueMember).
class TongueFamily {
 public:
  /// Throws ConfigError that names file, key, value and what is allowed.
  static TongueFamily load(const std::string& path);
  /// Whether a file is that of a tongue family, by its key `tongue`.
  static bool isOne(const std::string& path);

  const std::string& name() const { return name_; }
  const std::vector<Family::Parameter>& parameters() const { return parameters_; }  ///< of mouthRatios()
  int dimension() const { return static_cast<int>(parameters_.size()); }

  /// The member at these coordinates, without dimension.
  Scene member(const Eigen::VectorXd& coordinates) const;
  /// Coordinates of a scene with a mouth; outside of [-1, 1] beyond the borders. A thicker wall than the highest is as
  /// that, because the cell does not touch its outside any more. Nothing when the scene differs in something else;
  /// `misfit` then says in what, for the user. Needle, pressure and viscoelasticity are not compared.
  std::optional<Eigen::VectorXd> coordinatesOf(const Scene& scene, std::string* misfit = nullptr) const;
  /// Which ratio is outside of its borders, its value and what is allowed; empty: none is.
  std::string refusal(const Eigen::VectorXd& coordinates) const;

  /// One line with everything that the data of the family depend on.
  std::string description() const;

 private:
  std::string misfitOf(const Scene& scene, Eigen::VectorXd& coordinates) const;

  std::string name_;
  Scene scene_;
  std::vector<Family::Parameter> parameters_, constants_;
};

}  // namespace microinjection
