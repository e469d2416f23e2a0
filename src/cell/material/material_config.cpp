#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "base/errors.h"
#include "cell/material/corotated.h"
#include "cell/material/lame.h"
#include "cell/material/linear_material.h"
#include "cell/material/material.h"
#include "cell/material/mooney_rivlin.h"
#include "cell/material/neo_hookean.h"
#include "cell/material/st_venant_kirchhoff.h"
#include "cell/material/stable_neo_hookean.h"

namespace microinjection {
namespace {

using Factory = std::unique_ptr<Material> (*)(const Lame&, const MaterialConfig&);

template <typename Model>
std::unique_ptr<Material> make(const Lame& lame, const MaterialConfig&) {
  return std::make_unique<Model>(lame);
}

std::unique_ptr<Material> makeMooneyRivlin(const Lame& lame, const MaterialConfig& config) {
  return std::make_unique<MooneyRivlin>(lame, config.mooney_ratio);
}

const std::pair<const char*, Factory> kModels[] = {{"linear", make<LinearMaterial>},
                                                   {"st_venant_kirchhoff", make<StVenantKirchhoff>},
                                                   {"neo_hookean", make<NeoHookean>},
                                                   {"mooney_rivlin", makeMooneyRivlin},
                                                   {"stable_neo_hookean", make<StableNeoHookean>},
                                                   {"corotated", make<Corotated>}};

std::string listOfModels() {
  std::string list;
  for (const std::string& model : materialModels()) list += (list.empty() ? "" : ", ") + model;
  return list;
}

}  // namespace

const std::vector<std::string>& materialModels() {
  static const std::vector<std::string> models = [] {
    std::vector<std::string> names;
    for (const auto& [name, factory] : kModels) names.emplace_back(name);
    return names;
  }();
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
  if (std::find(models.begin(), models.end(), model) == models.end())
    report("model", model, "one of: " + listOfModels());
  if (!(std::isfinite(young_modulus) && young_modulus > 0)) report("young_modulus", young_modulus, "in (0, inf) Pa");
  if (!(poisson_ratio > -1 && poisson_ratio < 0.5)) report("poisson_ratio", poisson_ratio, "in (-1, 0.5)");
  if (!(mooney_ratio >= 0 && mooney_ratio <= 1)) report("mooney_ratio", mooney_ratio, "in [0, 1]");
  for (const std::string& error : viscoelasticity.errors()) errors.push_back("material: viscoelasticity/" + error);
  if (!errors.empty()) throw ConfigError(errors);
}

std::unique_ptr<Material> makeMaterial(const MaterialConfig& config) {
  config.validate();
  const Lame lame = Lame::from(config.young_modulus, config.poisson_ratio);
  for (const auto& [name, factory] : kModels) {
    if (config.model == name) return factory(lame, config);
  }
  return nullptr;  // not reached: the configuration is valid
}

}  // namespace microinjection
