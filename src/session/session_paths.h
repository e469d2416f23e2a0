#pragma once

#include <string>

#include "base/paths.h"

namespace microinjection {

/// The path of NAME, package/`below`/NAME.yaml, or, where `text` has a slash or a point, the path that it is.
std::string pathOfFileOrName(const std::string& text, const std::string& folder, const std::string& package,
                             const std::string& below);

bool isFile(const std::string& path);

/// Folder of files that last as long as a user's login: $XDG_RUNTIME_DIR, else /tmp.
std::string runtimeFolder();

/// The folder that has `config` and `urdf`: the share folder of the installation that the running program is in, else
/// the sources that it was built from.
std::string packageFolder();

}  // namespace microinjection
