#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cell/material/lame.h"
#include "cell/material/material.h"

namespace microinjection {

using MaterialFactory = std::unique_ptr<Material> (*)(const Lame&, const MaterialConfig&);

/// The strain energies, each with the name that a scene gives it. Their formulas and sources stand at their classes,
/// which nobody else needs to know.
const std::vector<std::pair<std::string, MaterialFactory>>& materialFactories();

}  // namespace microinjection
