#pragma once

#include <string>

namespace microinjection {

/// Writes a whole file through a temporary file beside it that is renamed when complete, so that no
/// reader sees a part of it. Creates missing directories. Writes into a device or a pipe at `path`
/// without replacing it. Throws WriteError and then leaves an existing file as it was.
void writeFileAtomically(const std::string& path, const std::string& content);

/// Same, but replaces whatever is at `path` except a directory. A pipe without a reader would
/// block.
void replaceFileAtomically(const std::string& path, const std::string& content);

/// Creates the folder if it is missing, then writes and removes a small file in it. Throws
/// WriteError when that fails.
void requireWritableFolder(const std::string& folder);

}  // namespace microinjection
