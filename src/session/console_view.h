#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace microinjection {

/// The rviz configuration of the console NAME: config/session.rviz, overridden by config/console/common.rviz and then
/// by config/console/NAME.yaml.
std::string consoleView(const std::string& package, const std::string& name);

/// A part of an rviz configuration over another: keys by their name, elements of a list by their Name. An element with
/// another Name is added.
YAML::Node mergedView(const YAML::Node& base, const YAML::Node& part);

}  // namespace microinjection
