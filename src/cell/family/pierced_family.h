#pragma once

#include <optional>
#include <string>

#include "cell/family/section_family_data.h"
#include "cell/model/pierced_branch.h"

namespace microinjection {

/// The branches of a cell that is pierced by mechanics, as a family has them.
struct FamilyBranch {
  PiercedBranch branch;
  double whole_error = 0;    ///< relative, of the force before the onset: one of ten has more
  double pierced_error = 0;  ///< same, behind it, on the way in
};

/// Solves the paths of a member (solved_branch.h) and brings them onto the knots that all members have. Takes half a
/// minute.
/// @throws std::runtime_error where nothing pierces it, and as solvePiercedBranch()
SectionMember solvePierced(const SectionFamily& family, const Eigen::VectorXd& coordinates);

/// Branches of all cells of a family, made from solved ones, for holes to 6 tip radii: longer ones are continued.
/// Energies and forces of the members are summed with the same weights, so that a force is still the derivative of an
/// energy.
class PiercedFamily {
 public:
  /// @throws std::invalid_argument for data of another kind
  explicit PiercedFamily(SectionFamilyData data);

  const SectionFamilyData& data() const { return data_; }
  /// @pre piercedByMechanics(scene). @throws ConfigError as SectionFamilyData::predict()
  FamilyBranch branch(const Scene& scene) const;

 private:
  SectionFamilyData data_;
};

/// The branches of a scene by the first family in the folder `pierced` of a folder of families (empty: none) that has
/// it; nothing when none has: `reason` is one line for the user.
std::optional<FamilyBranch> findFamilyBranch(const std::string& families, const Scene& scene, std::string& reason);

}  // namespace microinjection
