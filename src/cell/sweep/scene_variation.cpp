#include "cell/sweep/scene_variation.h"

#include <cstddef>
#include <sstream>

#include "base/errors.h"
#include "base/parse_number.h"

namespace microinjection {
namespace {

constexpr int kDeepest = 100;

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

/// A copy in which an alias is a node of its own. YAML::Clone keeps aliases as one node, and to set one would change
/// them all. An alias of what it is in has no end, and a scene is never so deep.
YAML::Node copy(const YAML::Node& node, int depth) {
  if (depth > kDeepest) throw ConfigError("the scene is deeper than " + std::to_string(kDeepest) + " maps and lists");
  if (!node.IsMap() && !node.IsSequence()) return YAML::Clone(node);
  YAML::Node result(node.Type());
  result.SetTag(node.Tag());
  result.SetStyle(node.Style());
  for (const auto& each : node) {
    if (node.IsSequence()) {
      result.push_back(copy(each, depth + 1));
    } else {
      result.force_insert(copy(each.first, depth + 1), copy(each.second, depth + 1));
    }
  }
  return result;
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
  YAML::Node result = copy(scene, 0);
  for (std::size_t i = 0; i < keys.size(); ++i) set(result, keys[i], values.at(i));
  return result;
}

}  // namespace microinjection
