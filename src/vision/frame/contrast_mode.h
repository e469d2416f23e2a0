#pragma once

#include <string>

#include "base/config_reader.h"

namespace microinjection {

/// How the microscope makes a transparent cell visible, which decides whether its border is a dark line, has a halo
/// beside it, or is bright on one side and dark on the other. kUnknown is for images of which nobody has told:
/// detectors then take a border of either sign where that is safe.
enum class ContrastMode { kUnknown, kBrightField, kPhase, kDic };

/// "unknown", "bright_field", "phase", "dic".
const char* toText(ContrastMode mode);
/// @throws ConfigError for a text that is none of these
ContrastMode contrastModeOf(const std::string& text);
/// Reads an optional key. The mode of a microscope is known, that of an image need not be.
void readContrastMode(ConfigReader& reader, const std::string& key, ContrastMode& mode, bool may_be_unknown);

}  // namespace microinjection
