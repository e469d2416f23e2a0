#pragma once

#include <optional>
#include <string>

#include "cell/family/family_tongue.h"
#include "cell/family/section_family_data.h"

namespace microinjection {

/// Tongues of all cells of a family at any suction, made from solved ones (tongue_member.h):
///
///     ratios --> coordinates --> SectionFamilyData: a weight for each member --> FamilyTongue, at(suction / E)
///
class TongueFamily {
 public:
  /// @throws std::invalid_argument for data of another kind
  explicit TongueFamily(SectionFamilyData data);
  /// Of a family file with its data beside it. @throws ConfigError where one of them cannot be used
  static TongueFamily load(const std::string& family_file);

  const SectionFamilyData& data() const { return data_; }

  /// Takes some ten microseconds. @throws ConfigError as SectionFamilyData::predict()
  FamilyTongue tongue(const Eigen::VectorXd& coordinates) const;
  /// Of a scene in SI units. @throws ConfigError also for a scene of another form
  FamilyTongue tongue(const Scene& scene) const;

 private:
  SectionFamilyData data_;
};

/// The tongue of a scene's cell by the first family in the folder `tongues` of a folder of families that has it;
/// nothing when none has: `reason` is one line for the user.
std::optional<FamilyTongue> findFamilyTongue(const std::string& families, const Scene& scene, std::string& reason);

}  // namespace microinjection
