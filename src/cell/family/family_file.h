#pragma once

#include <string>
#include <vector>

namespace microinjection {

/// The data of a family are beside its file: homogeneous.data for homogeneous.yaml.
std::string familyDataFile(const std::string& family_file);

/// The families' files in a folder (*.yaml), sorted; none when there is no such folder.
std::vector<std::string> familyFiles(const std::string& folder);

}  // namespace microinjection
