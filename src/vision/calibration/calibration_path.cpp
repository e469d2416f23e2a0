#include "vision/calibration/calibration_path.h"

#include "base/user_data.h"

namespace microinjection {

std::string calibrationPath(const std::string& configured) {
  return configured.empty() ? userDataFile("calibration.yaml") : configured;
}

}  // namespace microinjection
