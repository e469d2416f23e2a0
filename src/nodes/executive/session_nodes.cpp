#include "nodes/executive/session_nodes.h"

#include "nodes/executive/node_registry.h"

namespace microinjection {
namespace {

YAML::Node frameParameters(const SessionPlan& plan) {
  YAML::Node parameters(YAML::NodeType::Map);
  for (const StaticFrame& frame : plan.frames) {
    YAML::Node entry;
    entry["parent"] = frame.parent;
    entry["child"] = frame.child;
    for (const double number : frame.place) entry["pose"].push_back(number);
    parameters["frames"].push_back(entry);
  }
  return parameters;
}

}  // namespace

void addNodes(Executive& executive, const SessionPlan& plan) {
  for (const auto& parameter : plan.parameters)
    executive.network().setParameter("/" + parameter.first.as<std::string>(), parameter.second);
  // First: others wait for a frame in their constructors.
  executive.add(kRigFrames, nodeFactory(kRigFrames), frameParameters(plan));
  for (const NodePlan& node : plan.nodes)
    executive.add(node.name, nodeFactory(node.program), node.parameters, node.remaps);
}

}  // namespace microinjection
