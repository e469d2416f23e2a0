#pragma once

#include <string>

namespace microinjection {

/// The folder that has `config` and `urdf`: the share folder of the installation that the running program is in, else
/// the sources that it was built from.
std::string packageFolder();

}  // namespace microinjection
