#pragma once

#include <memory>
#include <optional>
#include <string>

#include "cell/family/family_data.h"

namespace microinjection {

/// A scene's cell, made from a family.
struct FamilyCell {
  std::shared_ptr<const FamilyData> family;
  std::shared_ptr<const SurrogateData> data;  ///< in the scene's units
  std::string description;                    ///< one line: the family, its borders, the expected error
};

/// The member of `family` that a scene is, in the scene's units. Takes milliseconds. Without one,
/// `reason` is one line for the user.
std::optional<FamilyCell> makeFamilyCell(const std::shared_ptr<const FamilyData>& family, const Scene& scene,
                                         std::string& reason);

/// Searches the families of a folder (*.yaml with their data beside them; an empty name for none).
std::optional<FamilyCell> findFamilyCell(const std::string& folder, const Scene& scene, std::string& reason);

/// One line for the user: the family of a scene's cell with the expected error, or why it has none.
std::string describeFamilyOf(const Scene& scene, const std::string& folder);

}  // namespace microinjection
