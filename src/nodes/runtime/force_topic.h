#pragma once

#include <string>

namespace microinjection {

/// Topic of the force on the tip for a `force_source` parameter: "predicted" by the cell model or
/// "measured".
inline std::string forceTopic(const std::string& force_source) {
  return force_source == "measured" ? "force_sensor/measured_cf" : "cell/predicted_cf";
}

}  // namespace microinjection
