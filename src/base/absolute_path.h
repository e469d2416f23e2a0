#pragma once

#include <string>

namespace microinjection {

/// A path as its file means it: from `folder`, or from the home folder where it begins with ~/.
std::string absolutePath(const std::string& path, const std::string& folder);

}  // namespace microinjection
