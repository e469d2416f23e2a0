#pragma once

#include <vector>

#include "base/range.h"
#include "cell/material/material.h"

namespace microinjection {

/// A number of a material, and all that the rest of the house has to know of it: reading, checking, identity of
/// surrogate data and scaling go through this list. A new one is entered here and in MaterialConfig, and the model that
/// has it reads it.
struct MaterialParameter {
  const char* name;  ///< key in a scene, member of MaterialConfig
  double MaterialConfig::*value;
  Range allowed;
  const char* unit;   ///< as scenes write it; empty: none
  const char* model;  ///< the one that has it; empty: all have it, and a scene must
  int stresses = 0;   ///< power of a stress in its unit: what it is divided by in a scene without dimension

  bool ofAllModels() const { return *model == 0; }
};

const std::vector<MaterialParameter>& materialParameters();

}  // namespace microinjection
