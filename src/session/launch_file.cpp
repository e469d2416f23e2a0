#include "session/launch_file.h"

#include "base/errors.h"
#include "session/parameter_tree.h"

namespace microinjection {
namespace {

/// For XML, within an element.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char each : text) {
    if (each == '&')
      result += "&amp;";
    else if (each == '<')
      result += "&lt;";
    else if (each == '>')
      result += "&gt;";
    else
      result += each;
  }
  return result;
}

std::string attribute(const std::string& name, const std::string& value) {
  std::string text;
  for (const char each : escaped(value)) text += each == '"' ? std::string("&quot;") : std::string(1, each);
  return " " + name + "=\"" + text + "\"";
}

std::string parametersText(const YAML::Node& parameters, int indent) {
  if (parameters.size() == 0) return "";
  const std::string space(indent, ' ');
  return space + "<rosparam>\n" + escaped(parameterText(parameters, indent + 2)) + space + "</rosparam>\n";
}

/// A map is the parameters of a node that a person starts: those of an earlier session on this master go, too.
std::string globalParametersText(const YAML::Node& parameters) {
  YAML::Node values(YAML::NodeType::Map);
  std::string groups;
  for (const auto& item : parameters) {
    const std::string name = item.first.Scalar();
    if (!item.second.IsMap()) {
      values[name] = item.second;
    } else {
      groups += "  <group" + attribute("ns", name) + attribute("clear_params", "true") + ">\n" +
                parametersText(item.second, 4) + "  </group>\n";
    }
  }
  return parametersText(values, 2) + groups;
}

std::string remapsText(const std::map<std::string, std::string>& remaps) {
  std::string text;
  for (const auto& [from, to] : remaps) text += "    <remap" + attribute("from", from) + attribute("to", to) + "/>\n";
  return text;
}

std::string element(const std::string& package, const std::string& type, const std::string& name,
                    const std::string& attributes, const std::string& content) {
  const std::string begin =
      "  <node" + attribute("pkg", package) + attribute("type", type) + attribute("name", name) + attributes;
  return begin + (content.empty() ? "/>\n" : ">\n" + content + "  </node>\n");
}

std::string nodeText(const NodePlan& node) {
  std::string attributes;
  if (node.nice > 0) attributes += attribute("launch-prefix", "nice -n " + std::to_string(node.nice));
  if (node.respawn) attributes += attribute("respawn", "true");
  if (node.required) attributes += attribute("required", "true");
  // A node refuses parameters that it does not know: those of an earlier session on this master go.
  attributes += attribute("clear_params", "true") + attribute("output", "screen");
  return element("cell_microinjection", node.program, node.name, attributes,
                 parametersText(node.parameters, 4) + remapsText(node.remaps));
}

std::string frameText(const StaticFrame& frame) {
  std::string arguments;
  for (const double value : frame.place) arguments += numberText(value) + " ";
  return element("tf2_ros", "static_transform_publisher", frame.name,
                 attribute("args", arguments + frame.parent + " " + frame.child), "");
}

std::string processText(const ForeignProcess& process, const std::string& view_file) {
  std::string arguments = join(process.arguments, " "), attributes;
  if (!process.view.empty()) arguments += " " + view_file;
  if (!process.prefix.empty()) attributes += attribute("launch-prefix", process.prefix);
  if (!arguments.empty()) attributes += attribute("args", arguments);
  if (process.package == "cell_microinjection") attributes += attribute("output", "screen");
  std::string content;
  for (const auto& [name, value] : process.environment)
    content += "    <env" + attribute("name", name) + attribute("value", value) + "/>\n";
  return element(process.package, process.program, process.name, attributes, content + remapsText(process.remaps));
}

}  // namespace

std::string launchText(const SessionPlan& plan, const std::string& view_file) {
  std::string text = "<launch>\n" + globalParametersText(plan.parameters);
  for (const NodePlan& node : plan.nodes) text += nodeText(node);
  for (const StaticFrame& frame : plan.frames) text += frameText(frame);
  for (const ForeignProcess& process : plan.processes) text += processText(process, view_file);
  return text + "</launch>\n";
}

std::string rvizView(const SessionPlan& plan) {
  for (const ForeignProcess& process : plan.processes)
    if (!process.view.empty()) return process.view;
  return "";
}

}  // namespace microinjection
