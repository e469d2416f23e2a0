#include "vision/calibration/calibration_path.h"

#include <cstdlib>

namespace microinjection {

std::string calibrationPath(const std::string& configured) {
  if (!configured.empty()) return configured;
  const char* data = std::getenv("XDG_DATA_HOME");
  const char* home = std::getenv("HOME");
  const std::string base = data && *data ? data : std::string(home ? home : "/tmp") + "/.local/share";
  return base + "/cell_microinjection/calibration.yaml";
}

}  // namespace microinjection
