#pragma once

#include <string>

#include "base/config_reader.h"

namespace microinjection {

/// The end of a device's lines, by its name: CR, LF or CRLF. A name, because a parameter server is no place for the
/// characters themselves: on their way through it both \r\n and \r become \n.
/// Keeps `bytes` where the key is absent.
void readLineEnding(ConfigReader& reader, const std::string& key, std::string& bytes);

/// Reads a text of visible characters and blanks. Others are an error of the key, which names the character and says
/// how a line's end is written instead.
void readPlainText(ConfigReader& reader, const std::string& key, std::string& text,
                   ConfigReader::Presence presence = ConfigReader::kOptional);

}  // namespace microinjection
