#include "cell/mesh/config_check.h"

#include <cmath>
#include <sstream>

#include "base/errors.h"

namespace microinjection {

void ConfigCheck::require(bool good, const std::string& key, double value, const std::string& allowed) {
  std::ostringstream message;
  message << subject_ << ": " << key << " = " << value << ": must be " << allowed;
  if (!good) errors_.push_back(message.str());
}

bool ConfigCheck::requireLayers(const std::vector<double>& radii, double thinnest) {
  if (radii.empty()) {
    errors_.push_back(subject_ + ": radii is empty: must be at least the radius of the cell");
    return false;
  }
  const std::size_t errors_before = errors_.size();
  std::ostringstream thickness;
  thickness << "positive, and each layer at least " << thinnest << " of the first radius thick";
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const double next = i + 1 < radii.size() ? radii[i + 1] : 0;
    const bool good = isPositive(radii[i]) && !(radii[i] - next < thinnest * radii[0]);
    require(good, keyOf("radii", i), radii[i], "descending, " + thickness.str());
  }
  return errors_.size() == errors_before;
}

void ConfigCheck::finish() const {
  if (!errors_.empty()) throw ConfigError(errors_);
}

bool isPositive(double value) { return std::isfinite(value) && value > 0; }

std::string keyOf(const std::string& key, std::size_t index, const std::string& field) {
  return key + '[' + std::to_string(index) + ']' + (field.empty() ? "" : "." + field);
}

}  // namespace microinjection
