#pragma once

#include <string>

#include "cell/model/scene.h"

namespace microinjection {

/// A neo-Hookean cell under a hemispherical tip.
inline Scene pipetteScene(const std::string& contact_mode = "sticking") {
  Scene scene;
  scene.cell.material() = {"neo_hookean", 17.9e3, 0.49};
  scene.needle.tip.shape = "hemisphere";
  scene.needle.contact.mode = contact_mode;
  return scene;
}

/// A cell of few elements under a disc.
inline Scene coarseScene(const std::string& model) {
  Scene scene;
  scene.cell.material() = {model, 17.9e3, 0.45};
  scene.mesh.size = 20e-6;
  return scene;
}

}  // namespace microinjection
