#pragma once

#include <string>

namespace microinjection {

/// File of the last calibration: `configured`, or where that is empty
/// cell_microinjection/calibration.yaml in $XDG_DATA_HOME, else in ~/.local/share.
std::string calibrationPath(const std::string& configured);

}  // namespace microinjection
