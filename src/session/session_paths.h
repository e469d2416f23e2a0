#pragma once

#include <string>

namespace microinjection {

/// A path as its file means it: from `folder`, or from the home folder where it begins with ~/.
std::string absolutePath(const std::string& path, const std::string& folder);

/// The path of NAME, package/`below`/NAME.yaml, or, where `text` has a slash or a point, the path that it is.
std::string pathOfFileOrName(const std::string& text, const std::string& folder, const std::string& package,
                             const std::string& below);

bool isFile(const std::string& path);

/// Folder of files that last as long as a user's login: $XDG_RUNTIME_DIR, else /tmp.
std::string runtimeFolder();

}  // namespace microinjection
