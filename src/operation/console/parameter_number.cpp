#include "operation/console/parameter_number.h"

#include "base/config_reader.h"
#include "base/errors.h"

namespace microinjection {

std::optional<double> parameterNumber(const std::string& node, const std::string& key, const std::string& text,
                                      std::string& error) {
  YAML::Node map(YAML::NodeType::Map);
  map[key] = text;
  ConfigReader reader(map, node);
  double value = 0;
  reader.number(key, value);
  try {
    reader.finish();
    return value;
  } catch (const ConfigError& refusal) {
    error += (error.empty() ? "" : "; ") + std::string(refusal.what());
    return std::nullopt;
  }
}

}  // namespace microinjection
