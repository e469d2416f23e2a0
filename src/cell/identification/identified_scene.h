#pragma once

#include <string>

#include "cell/identification/identification.h"

namespace microinjection {

/// The text of a scene file with what was identified: all layers' moduli change by the same factor, so
/// that the outermost one has the modulus found; shell_thickness, core_modulus and tip_radius (ratios),
/// a parameter of a material's model (in all layers of that model) and Prony terms are set if they were
/// estimated. Its head says where it comes from. Throws
/// ConfigError when the scene lacks a key.
std::string identifiedScene(const std::string& scene_path, const std::string& record_path,
                            const Identification& identification);

}  // namespace microinjection
