#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace microinjection {

/// Parameters of a node as a YAML map, and values in it by their path, such as "motion/travel_limit".

YAML::Node emptyMap();

/// Undefined when it is absent.
YAML::Node parameterAt(const YAML::Node& parameters, const std::string& path);
/// Makes the maps on the way.
void setParameter(YAML::Node parameters, const std::string& path, const YAML::Node& value);
/// Sets copies of the values of `more`, map by map and key by key; a list is replaced as a whole.
void mergeParameters(YAML::Node parameters, const YAML::Node& more);

/// Values that keep their type in parameterText: "true" as a text is not true.
YAML::Node textValue(const std::string& value);
YAML::Node numberValue(double value);
YAML::Node integerValue(int value);
YAML::Node booleanValue(bool value);

/// The shortest decimal number that reads back as the same value, as 1.2e-05 or 3.0: with a point, without which
/// YAML 1.1 takes it for a text.
std::string numberText(double value);

/// The map as YAML that a reader of YAML 1.1 (rosparam) and one of 1.2 (yaml-cpp) understand alike. Each line begins
/// with `indent` spaces.
std::string parameterText(const YAML::Node& parameters, int indent = 0);
/// A scalar as parameterText writes it.
std::string scalarText(const YAML::Node& scalar);

/// To six digits, so that a scaled parameter has no tail of 1e-21.
double roundedParameter(double value);
/// With up to `digits` digits, for messages: 2e-05.
std::string shortNumber(double value, int digits = 6);

}  // namespace microinjection
