#pragma once

#include <string>

namespace microinjection {

/// Writes a whole file so that no reader ever sees half of it: into a temporary file beside it, renamed when complete.
/// Missing directories are made. Throws std::runtime_error that names the path and the system's reason; the file that
/// was there before is then untouched.
void writeFileAtomically(const std::string& path, const std::string& content);

}  // namespace microinjection
