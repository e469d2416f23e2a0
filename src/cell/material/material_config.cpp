#include <utility>

#include "base/config_errors.h"
#include "cell/material/lame.h"
#include "cell/material/material.h"
#include "cell/material/material_models.h"
#include "cell/material/material_parameter.h"

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

}  // namespace

const std::vector<std::string>& materialModels() {
  static const std::vector<std::string> models = [] {
    std::vector<std::string> names;
    for (const auto& [name, factory] : kModels) names.emplace_back(name);
    return names;
  }();
  return models;
}

const std::vector<MaterialParameter>& materialParameters() {
  static const std::vector<MaterialParameter> parameters = {
      {"young_modulus", &MaterialConfig::young_modulus, Range::positive(), "Pa", "", 1},
      {"poisson_ratio", &MaterialConfig::poisson_ratio, Range::open(-1, 0.5), "", ""},
      {"mooney_ratio", &MaterialConfig::mooney_ratio, Range::closed(0, 1), "", "mooney_rivlin"}};
  return parameters;
}

void MaterialConfig::validate() const {
  ConfigErrors errors("material");
  errors.requireOneOf(materialModels(), "model", model);
  for (const MaterialParameter& each : materialParameters())
    errors.require(each.allowed, each.name, this->*each.value, *each.unit == 0 ? "" : std::string(" ") + each.unit);
  viscoelasticity.check("viscoelasticity/", errors);
  errors.throwAny();
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
