#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "cell/family/family.h"
#include "cell/model/scene.h"

namespace microinjection {

/// Cells in the mouth of a pipette that differ in a few ratios only (config/families/tongues and held, *.yaml), without
/// dimension: radius 1, modulus of the outermost layer 1. There are two kinds:
///
///     tongue       what a suction draws into the mouth; the needle is away (TongueFamily)
///     held_force   what a needle on the axis feels of a cell that suction holds, over a glued one (HeldForceFamily)
///
/// Beside Family rather than a kind of it, because its members are curves of the section, whose coordinates are those
/// of the mouth, while those of Family are force fields in space, with paths and a range.
class MouthFamily {
 public:
  enum class Kind { kTongue, kHeldForce };

  /// Throws ConfigError that names file, key, value and what is allowed.
  static MouthFamily load(const std::string& path);
  /// Of a family file, by its key `tongue` or `held_force`; nothing: it is that of a Family.
  static std::optional<Kind> kindOf(const std::string& path);

  Kind kind() const { return kind_; }
  const std::string& name() const { return name_; }
  const std::vector<Family::Parameter>& parameters() const { return parameters_; }  ///< of mouthRatios()
  int dimension() const { return static_cast<int>(parameters_.size()); }

  /// The member at these coordinates, without dimension.
  Scene member(const Eigen::VectorXd& coordinates) const;
  /// Coordinates of a scene with a mouth; outside of [-1, 1] beyond the borders. A thicker wall than the highest is as
  /// that, because the cell does not touch its outside any more. Nothing when the scene differs in something else;
  /// `misfit` then says in what, for the user. Viscoelasticity is not compared, nor, of tongues, needle and pressure.
  std::optional<Eigen::VectorXd> coordinatesOf(const Scene& scene, std::string* misfit = nullptr) const;
  /// Which ratio is outside of its borders, its value and what is allowed; empty: none is.
  std::string refusal(const Eigen::VectorXd& coordinates) const;

  /// One line with everything that the data of the family depend on.
  std::string description() const;

 private:
  std::string misfitOf(const Scene& scene, Eigen::VectorXd& coordinates) const;
  void checkMouth(class ConfigReader& reader) const;

  Kind kind_ = Kind::kTongue;
  std::string name_;
  Scene scene_;
  std::vector<Family::Parameter> parameters_, constants_;
};

}  // namespace microinjection
