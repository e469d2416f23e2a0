#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/errors.h"

namespace microinjection {

/// The data of a family are beside its file: homogeneous.data for homogeneous.yaml.
std::string familyDataFile(const std::string& family_file);

/// The families' files in a folder (*.yaml), sorted; none when there is no such folder.
std::vector<std::string> familyFiles(const std::string& folder);

/// What the first family in `folder` of a folder of families has, that `find` does not refuse by a ConfigError. Nothing
/// when none has, or there are no families (empty): `reason` is one line for the user, empty without families.
template <typename Find>
auto firstFamilyWith(const std::string& families, const std::string& folder, std::string& reason, const Find& find)
    -> std::optional<decltype(find(std::string()))> {
  reason.clear();
  if (families.empty()) return std::nullopt;
  for (const std::string& file : familyFiles(families + "/" + folder)) {
    try {
      return find(file);
    } catch (const ConfigError& error) {
      reason += (reason.empty() ? "" : "; ") + std::string(error.what());
    }
  }
  if (reason.empty()) reason = families + "/" + folder + " has no family";
  return std::nullopt;
}

}  // namespace microinjection
