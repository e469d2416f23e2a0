#pragma once

#include <string>

namespace microinjection {

/// The data of a family are beside its file: homogeneous.data for homogeneous.yaml.
std::string familyDataFile(const std::string& family_file);

}  // namespace microinjection
