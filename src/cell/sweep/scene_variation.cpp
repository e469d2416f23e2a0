#include "cell/sweep/scene_variation.h"

#include <cstddef>
#include <sstream>

#include "base/errors.h"
#include "base/parse_number.h"

namespace microinjection {
namespace {

/// The node of one step below `node`.
YAML::Node below(YAML::Node node, const std::string& step, const std::string& key) {
  if (node.IsSequence()) {
    const auto index = parseNumber<std::size_t>(step);
    if (!index || *index >= node.size()) {
      throw ConfigError(key + ": there is no " + step + " in a list of " + std::to_string(node.size()));
    }
    return node[*index];
  }
  if (node.IsScalar()) throw ConfigError(key + ": " + step + " is below a value, which has no keys");
  return node[step];
}

void set(const YAML::Node& scene, const std::string& key, const std::string& value) {
  YAML::Node node = scene;
  std::istringstream steps(key);
  for (std::string step; std::getline(steps, step, '/');) node.reset(below(node, step, key));
  if (node.IsMap() || node.IsSequence()) throw ConfigError(key + ": is no value; name a key below it");
  node = value;
}

}  // namespace

YAML::Node varied(const YAML::Node& scene, const std::vector<std::string>& keys,
                  const std::vector<std::string>& values) {
  YAML::Node result = YAML::Clone(scene);
  for (std::size_t i = 0; i < keys.size(); ++i) set(result, keys[i], values.at(i));
  return result;
}

}  // namespace microinjection
