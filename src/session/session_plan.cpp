#include "session/session_plan.h"

#include <algorithm>

#include "base/errors.h"

namespace microinjection {
namespace {

template <typename Part>
void keep(std::vector<Part>& parts, const std::vector<std::string>& names) {
  const auto is_other = [&](const Part& part) {
    return std::find(names.begin(), names.end(), part.name) == names.end();
  };
  parts.erase(std::remove_if(parts.begin(), parts.end(), is_other), parts.end());
}

}  // namespace

const NodePlan* SessionPlan::node(const std::string& name) const {
  const auto found = std::find_if(nodes.begin(), nodes.end(), [&](const NodePlan& node) { return node.name == name; });
  return found == nodes.end() ? nullptr : &*found;
}

std::vector<std::string> SessionPlan::names() const {
  std::vector<std::string> names;
  for (const NodePlan& each : nodes) names.push_back(each.name);
  for (const StaticFrame& each : frames) names.push_back(each.name);
  for (const ForeignProcess& each : processes) names.push_back(each.name);
  return names;
}

bool SessionPlan::takesPart(const std::string& name) const {
  const std::vector<std::string> all = names();
  return std::find(all.begin(), all.end(), name) != all.end();
}

void SessionPlan::keepOnly(const std::vector<std::string>& wanted) {
  std::vector<std::string> errors;
  for (const std::string& name : wanted) {
    if (!takesPart(name))
      errors.push_back("only = " + name + ": this session has no such node; must be one of: " + join(names(), ", "));
  }
  if (!errors.empty()) throw ConfigError(errors);
  keep(nodes, wanted);
  keep(frames, wanted);
  keep(processes, wanted);
  const bool has_reader = takesPart("micromanipulator") || takesPart("robot_state_publisher");
  if (!has_reader) parameters.remove("robot_description");
}

}  // namespace microinjection
