#pragma once

#include <string>

#include "base/config_reader.h"

namespace microinjection {

enum class NoLineEnding { kRefused, kAllowed };

/// Reads a line ending by its name: CR, LF or CRLF, and NONE if allowed. The file has the name,
/// because a parameter server changes both \r\n and \r to \n. Keeps `bytes` if the key is absent.
void readLineEnding(ConfigReader& reader, const std::string& key, std::string& bytes,
                    NoLineEnding none = NoLineEnding::kRefused);

/// Reads a text of printable characters and blanks. Reports any other character as an error of the
/// key, and how a line ending is written instead.
void readPlainText(ConfigReader& reader, const std::string& key, std::string& text,
                   ConfigReader::Presence presence = ConfigReader::kOptional);

}  // namespace microinjection
