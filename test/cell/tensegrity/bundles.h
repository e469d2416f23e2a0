#pragma once

#include <memory>

#include "cell/tensegrity/tensegrity_structure.h"

namespace microinjection {

/// Bundles that bear the prestress, a coarse membrane.
inline TensegrityConfig bundles(double prestrain = 0.05) {
  TensegrityConfig config;
  config.actin.filaments.count = config.intermediate.filaments.count = 10;
  config.microtubules.filaments.count = 4000;
  config.actin.prestrain = config.intermediate.prestrain = prestrain;
  config.membrane.divisions = 3;
  return config;
}

inline std::shared_ptr<const TensegrityStructure> make(const TensegrityConfig& config) {
  return std::make_shared<const TensegrityStructure>(config);
}

/// The strut end that is highest.
inline int topEnd(const TensegrityGeometry& geometry) {
  int top = 0;
  for (int end = 1; end < 12; ++end) {
    if (geometry.ends[end].z() > geometry.ends[top].z() + 1e-12) top = end;
  }
  return top;
}

}  // namespace microinjection
