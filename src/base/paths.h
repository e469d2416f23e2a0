#pragma once

#include <string>

namespace microinjection {

/// Path of a file that a user keeps from session to session: cell_microinjection/NAME in
/// $XDG_DATA_HOME, else in ~/.local/share.
std::string userDataFile(const std::string& name);

/// A path as its file means it: from `folder`, or from the home folder where it begins with ~/.
std::string absolutePath(const std::string& path, const std::string& folder);

}  // namespace microinjection
