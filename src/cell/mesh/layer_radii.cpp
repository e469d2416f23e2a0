#include "cell/mesh/layer_radii.h"

#include <sstream>

namespace microinjection {

bool requireLayerRadii(const std::vector<double>& radii, double thinnest, ConfigErrors& errors) {
  if (radii.empty()) {
    errors.add("radii is empty: must be at least the radius of the cell");
    return false;
  }
  const std::size_t errors_before = errors.messages().size();
  std::ostringstream thickness;
  thickness << "positive, and each layer at least " << thinnest << " of the first radius thick";
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const double next = i + 1 < radii.size() ? radii[i + 1] : 0;
    const bool good = Range::positive().contains(radii[i]) && !(radii[i] - next < thinnest * radii[0]);
    errors.require(good, keyOf("radii", i), radii[i], "", "descending, " + thickness.str());
  }
  return errors.messages().size() == errors_before;
}

std::string keyOf(const std::string& key, std::size_t index, const std::string& field) {
  return key + '[' + std::to_string(index) + ']' + (field.empty() ? "" : "." + field);
}

}  // namespace microinjection
