#pragma once

#include <ros/node_handle.h>
#include <yaml-cpp/yaml.h>

#include "base/config_reader.h"

namespace microinjection {

/// The private parameters of a node as a YAML map, for strict reading by ConfigReader.
/// `diagnostic_period`, which belongs to diagnostic_updater, is left out.
YAML::Node privateParameters(const ros::NodeHandle& private_node);

/// A reader of a node's private parameters; its messages name the node.
ConfigReader parameterReader(const ros::NodeHandle& private_node);

}  // namespace microinjection
