#pragma once

#include <optional>
#include <string>

namespace microinjection {

/// The number that a node reads from a parameter which holds text: rosparam loads 2e-5, without a point, as text.
/// @param node   as "/injection_controller"
/// @param key    of the parameter below the node
/// @param error  the node's own words are appended where it is no number
std::optional<double> parameterNumber(const std::string& node, const std::string& key, const std::string& text,
                                      std::string& error);

}  // namespace microinjection
