#include "material/material.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/errors.h"
#include "material/lame.h"
#include "material/linear_material.h"
#include "material/neo_hookean.h"
#include "material/st_venant_kirchhoff.h"

namespace microinjection {

const std::vector<std::string>& materialModels() {
  static const std::vector<std::string> models = {"linear", "st_venant_kirchhoff", "neo_hookean"};
  return models;
}

void MaterialConfig::validate() const {
  std::vector<std::string> errors;
  const auto report = [&](const std::string& key, const auto& value, const std::string& allowed) {
    std::ostringstream message;
    message << "material: " << key << " = " << value << ": must be " << allowed;
    errors.push_back(message.str());
  };
  const std::vector<std::string>& models = materialModels();
  if (std::find(models.begin(), models.end(), model) == models.end()) {
    report("model", model, "one of: linear, st_venant_kirchhoff, neo_hookean");
  }
  if (!(std::isfinite(young_modulus) && young_modulus > 0)) report("young_modulus", young_modulus, "in (0, inf) Pa");
  if (!(poisson_ratio > -1 && poisson_ratio < 0.5)) report("poisson_ratio", poisson_ratio, "in (-1, 0.5)");
  if (!errors.empty()) throw ConfigError(errors);
}

std::unique_ptr<Material> makeMaterial(const MaterialConfig& config) {
  config.validate();
  const Lame lame = Lame::from(config.young_modulus, config.poisson_ratio);
  if (config.model == "linear") return std::make_unique<LinearMaterial>(lame);
  if (config.model == "st_venant_kirchhoff") return std::make_unique<StVenantKirchhoff>(lame);
  return std::make_unique<NeoHookean>(lame);
}

}  // namespace microinjection
