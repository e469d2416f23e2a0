#include "cell/material/viscoelasticity.h"

namespace microinjection {

void ViscoelasticityConfig::check(const std::string& path, ConfigErrors& errors) const {
  for (size_t i = 0; i < prony.size(); ++i) {
    const std::string term = path + "prony[" + std::to_string(i) + "]/";
    errors.require(Range::positive(), term + "modulus_ratio", prony[i].modulus_ratio);
    errors.require(Range::positive(), term + "relaxation_time", prony[i].relaxation_time, " s");
  }
  errors.require(Range::nonNegative(), path + "viscosity", viscosity, " Pa s");
}

}  // namespace microinjection
