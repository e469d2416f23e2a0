#pragma once

#include <xmlrpcpp/XmlRpcValue.h>
#include <yaml-cpp/yaml.h>

namespace microinjection {

/// A value of the ROS parameter server as YAML. (XmlRpcValue has no const access.)
YAML::Node toYaml(XmlRpc::XmlRpcValue& value);

}  // namespace microinjection
