#include "cell/material/viscoelasticity.h"

#include <cmath>
#include <sstream>

#include "base/errors.h"

namespace microinjection {

std::vector<std::string> ViscoelasticityConfig::errors() const {
  std::vector<std::string> result;
  const auto require = [&](bool good, const std::string& key, double value, const std::string& allowed) {
    std::ostringstream message;
    message << key << " = " << value << ": must be in " << allowed;
    if (!good) result.push_back(message.str());
  };
  const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
  for (size_t i = 0; i < prony.size(); ++i) {
    const std::string term = "prony[" + std::to_string(i) + "]/";
    require(positive(prony[i].modulus_ratio), term + "modulus_ratio", prony[i].modulus_ratio, "(0, inf)");
    require(positive(prony[i].relaxation_time), term + "relaxation_time", prony[i].relaxation_time, "(0, inf) s");
  }
  require(viscosity == 0 || positive(viscosity), "viscosity", viscosity, "[0, inf) Pa s");
  return result;
}

void ViscoelasticityConfig::validate() const {
  std::vector<std::string> messages = errors();
  for (std::string& message : messages) message.insert(0, "viscoelasticity: ");
  if (!messages.empty()) throw ConfigError(messages);
}

}  // namespace microinjection
