#include "nodes/node_parameters.h"

#include <sstream>

namespace microinjection {
namespace {

template <typename Value>
YAML::Node scalar(const Value& value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return YAML::Node(text.str());
}

YAML::Node toYaml(XmlRpc::XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean: return YAML::Node(static_cast<bool>(value));
    case XmlRpc::XmlRpcValue::TypeInt: return scalar(static_cast<int>(value));
    case XmlRpc::XmlRpcValue::TypeDouble: return scalar(static_cast<double>(value));
    case XmlRpc::XmlRpcValue::TypeString: return YAML::Node(static_cast<std::string>(value));
    case XmlRpc::XmlRpcValue::TypeArray: {
      YAML::Node list(YAML::NodeType::Sequence);
      for (int i = 0; i < value.size(); ++i) list.push_back(toYaml(value[i]));
      return list;
    }
    case XmlRpc::XmlRpcValue::TypeStruct: {
      YAML::Node map(YAML::NodeType::Map);
      for (auto& item : value) map[item.first] = toYaml(item.second);
      return map;
    }
    default: return YAML::Node(YAML::NodeType::Null);
  }
}

}  // namespace

YAML::Node privateParameters(const ros::NodeHandle& private_node) {
  XmlRpc::XmlRpcValue value;
  if (!private_node.getParam("", value) || value.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
    return YAML::Node(YAML::NodeType::Map);
  }
  YAML::Node map = toYaml(value);
  map.remove("diagnostic_period");
  return map;
}

ConfigReader parameterReader(const ros::NodeHandle& private_node) {
  return ConfigReader(privateParameters(private_node), private_node.getNamespace());
}

}  // namespace microinjection
