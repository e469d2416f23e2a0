#pragma once

#include <string>

namespace microinjection {

/// Flushes std::cout and stdout. Throws WriteError when that fails or when an earlier write to the
/// standard output failed, as on a full disk. Commands call it before they report success.
void flushStandardOutput();

/// Writes a command's table to a file, or for `-` to the standard output. @throws WriteError
void writeTable(const std::string& file, const std::string& table);

}  // namespace microinjection
