#pragma once

#include <optional>
#include <string>

#include "cell/family/section_family_data.h"
#include "cell/model/withdrawal_loss.h"

namespace microinjection {

/// Solves ways in and out of a member, from six depths, to where adhesion ends. Takes ten seconds.
/// @throws std::runtime_error where one from up to a fifth of the radius has no solution
SectionMember solveWithdrawal(const SectionFamily& family, const Eigen::VectorXd& coordinates);

/// What is lost on the way out of all cells of a family, made from solved ones: for turns at up to half of the cell's
/// radius.
class WithdrawalFamily {
 public:
  /// @throws std::invalid_argument for data of another kind
  explicit WithdrawalFamily(SectionFamilyData data);

  const SectionFamilyData& data() const { return data_; }
  /// @throws ConfigError as SectionFamilyData::predict()
  WithdrawalLoss loss(const Scene& scene) const;

 private:
  SectionFamilyData data_;
};

/// The loss of a scene by the first family in the folder `withdrawal` of a folder of families (empty: none) that has
/// it; nothing when none has: `reason` is one line for the user.
std::optional<WithdrawalLoss> findWithdrawal(const std::string& families, const Scene& scene, std::string& reason);

}  // namespace microinjection
