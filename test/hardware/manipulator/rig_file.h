#pragma once

#include <fstream>
#include <sstream>
#include <string>

namespace microinjection {

constexpr double kMargin = 2e-6;  // m, of the collision guard

/// The text of urdf/rig.urdf.
inline std::string rigUrdf() {
  std::ifstream file(std::string(MICROINJECTION_SOURCE_DIR) + "/urdf/rig.urdf");
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace microinjection
