#pragma once

#include <string>
#include <vector>

#include "cell/family/family_check.h"

namespace microinjection {

/// Converged places of members that the family has not, as text: a comment with its origin, the
/// names of the columns, a line for each place. They cost minutes for a member, and a comparison
/// with them milliseconds.
std::string writeReferences(const Family& family, int seed, const std::vector<ReferencePlace>& places);

/// Reads what writeReferences wrote. Empty when the file does not exist. Throws ConfigError that
/// names file, line and reason, also for places of another family, version or seed.
std::vector<ReferencePlace> readReferences(const Family& family, int seed, const std::string& path);

}  // namespace microinjection
