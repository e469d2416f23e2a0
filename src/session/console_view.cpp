#include "session/console_view.h"

#include <vector>

#include "base/config_reader.h"

namespace microinjection {
namespace {

std::string nameOf(const YAML::Node& element) {
  if (!element.IsMap()) return "";
  const YAML::Node name = element["Name"];
  return name.IsDefined() && name.IsScalar() ? name.Scalar() : "";
}

YAML::Node mergedList(const YAML::Node& base, const YAML::Node& part) {
  YAML::Node result(YAML::NodeType::Sequence);
  std::vector<bool> used(part.size(), false);
  for (std::size_t i = 0; i < base.size(); ++i) {
    YAML::Node element = YAML::Clone(base[i]);
    for (std::size_t j = 0; j < part.size(); ++j) {
      if (used[j] || nameOf(part[j]) != nameOf(base[i])) continue;
      used[j] = true;
      element.reset(mergedView(base[i], part[j]));
    }
    result.push_back(element);
  }
  for (std::size_t j = 0; j < part.size(); ++j)
    if (!used[j]) result.push_back(YAML::Clone(part[j]));
  return result;
}

}  // namespace

YAML::Node mergedView(const YAML::Node& base, const YAML::Node& part) {
  if (base.IsSequence() && part.IsSequence()) return mergedList(base, part);
  if (!base.IsMap() || !part.IsMap()) return YAML::Clone(part);
  YAML::Node result = YAML::Clone(base);
  for (const auto& item : part) {
    const YAML::Node there = base[item.first.Scalar()];
    result[item.first.Scalar()] = there.IsDefined() ? mergedView(there, item.second) : YAML::Clone(item.second);
  }
  return result;
}

std::string consoleView(const std::string& package, const std::string& name) {
  YAML::Node view = loadYamlMap(package + "/config/session.rviz");
  for (const std::string& file : {std::string("common.rviz"), name + ".yaml"})
    view = mergedView(view, loadYamlMap(package + "/config/console/" + file));
  return YAML::Dump(view) + "\n";
}

}  // namespace microinjection
