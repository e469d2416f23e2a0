#pragma once

#include <string>

namespace microinjection {

/// Writes a whole file so that no reader ever sees half of it: into a temporary file beside it, renamed when complete.
/// Missing directories are made. A device or a pipe at `path` is written to, not replaced. Throws WriteError; a file
/// that was there before is then untouched.
void writeFileAtomically(const std::string& path, const std::string& content);

/// Same, but replaces whatever is at `path` except a directory: opening a pipe that nobody reads would wait for ever.
void replaceFileAtomically(const std::string& path, const std::string& content);

/// Makes the folder if it is missing, then writes and removes a small file in it. Throws WriteError when it cannot.
void requireWritableFolder(const std::string& folder);

}  // namespace microinjection
