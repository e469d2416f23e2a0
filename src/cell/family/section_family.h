#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "cell/family/family.h"
#include "cell/model/scene.h"

namespace microinjection {

/// Cells that differ in a few ratios only and whose members are curves of the section, without dimension: radius 1,
/// modulus of the outermost layer 1. There are five kinds, each a key of its files in a folder of config/families:
///
///     tongue          tongues/   what a suction draws into the mouth; the needle is away (TongueFamily)
///     held_force      held/      what a needle on the axis feels of a cell that suction holds, over a glued one
///                                (AxisForceRatioFamily)
///     friction_force  friction/  what a needle on the axis feels if it rubs, over one that sticks (same)
///     withdrawal      withdrawal/  what one that rubs or adheres loses on its way out (WithdrawalFamily)
///     pierced         pierced/   the branches of a cell that is pierced by mechanics (PiercedFamily)
///
/// Beside Family rather than a kind of it, because those of Family are force fields in space, with paths and a range.
class SectionFamily {
 public:
  enum class Kind { kTongue, kHeldForce, kFrictionForce, kWithdrawal, kPierced };

  /// Throws ConfigError that names file, key, value and what is allowed.
  static SectionFamily load(const std::string& path);
  /// Of a family file, by the key of a kind; nothing: it is that of a Family.
  static std::optional<Kind> kindOf(const std::string& path);

  Kind kind() const { return kind_; }
  const std::string& name() const { return name_; }
  const std::vector<Family::Parameter>& parameters() const { return parameters_; }  ///< of the kind's ratios
  int dimension() const { return static_cast<int>(parameters_.size()); }

  /// The member at these coordinates, without dimension.
  Scene member(const Eigen::VectorXd& coordinates) const;
  /// Coordinates of a scene; outside of [-1, 1] beyond the borders. A thicker wall than the highest is as that, because
  /// the cell does not touch its outside any more, and so is more friction, because the tip sticks; one that sticks has
  /// the highest. Nothing when the scene differs in something else; `misfit` then says in what, for the user.
  /// Viscoelasticity is not compared, nor, of tongues, needle and pressure.
  std::optional<Eigen::VectorXd> coordinatesOf(const Scene& scene, std::string* misfit = nullptr) const;
  /// Which ratio is outside of its borders, its value and what is allowed; empty: none is.
  std::string refusal(const Eigen::VectorXd& coordinates) const;

  /// One line with everything that the data of the family depend on.
  std::string description() const;

 private:
  bool hasMouth() const { return kind_ == Kind::kTongue || kind_ == Kind::kHeldForce; }
  std::string formMisfit(const Scene& scene) const;
  std::string misfitOf(const Scene& scene, Eigen::VectorXd& coordinates) const;
  bool names(const std::string& ratio) const;  ///< as a parameter or a constant
  double valueOf(const Family::Parameter& parameter, const Scene& scene) const;
  void checkMouth(class ConfigReader& reader) const;

  Kind kind_ = Kind::kTongue;
  std::string name_;
  Scene scene_;
  std::vector<Family::Parameter> parameters_, constants_;
};

}  // namespace microinjection
