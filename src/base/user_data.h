#pragma once

#include <string>

namespace microinjection {

/// Path of a file that a user keeps from session to session: cell_microinjection/NAME in
/// $XDG_DATA_HOME, else in ~/.local/share.
std::string userDataFile(const std::string& name);

}  // namespace microinjection
