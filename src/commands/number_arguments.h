#pragma once

#include <string>
#include <vector>

namespace microinjection {

/// Numbers of an option's text, with commas between them. Throws ConfigError that names the option, the text and what
/// is `wanted`; each must be finite.
std::vector<double> parseNumbers(const std::string& option, const std::string& text, const std::string& wanted);

/// One number above zero (`zero`: or zero); `unit` stands in the message, as " (m/s)". Throws as parseNumbers().
double parsePositive(const std::string& option, const std::string& text, const std::string& unit, bool zero = false);

}  // namespace microinjection
