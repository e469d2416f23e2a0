#pragma once

#include <string>
#include <vector>

namespace microinjection {

/// The lines of a text file in UTF-8, whatever it is written in: UTF-8, UTF-16 or Latin-1, with or without a byte order
/// mark, lines ended by LF, CR or CRLF, compressed by gzip or not. `notes` takes what was converted. Throws ConfigError
/// when the file cannot be read, or has NUL (it is binary).
std::vector<std::string> readTextLines(const std::string& path, std::vector<std::string>& notes);

}  // namespace microinjection
