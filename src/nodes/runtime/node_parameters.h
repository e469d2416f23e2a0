#pragma once

#include <ros/node_handle.h>
#include <yaml-cpp/yaml.h>

#include "base/config_reader.h"

namespace microinjection {

/// The private namespace of a node as a YAML map, to be read strictly by ConfigReader. ROS itself may put
/// `diagnostic_period` there, which is left out.
YAML::Node privateParameters(const ros::NodeHandle& private_node);

/// A reader over a node's private parameters whose messages name the node.
ConfigReader parameterReader(const ros::NodeHandle& private_node);

}  // namespace microinjection
