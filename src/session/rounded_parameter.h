#pragma once

#include <string>

namespace microinjection {

/// To six digits, so that a scaled parameter has no tail of 1e-21.
double roundedParameter(double value);
/// With up to `digits` digits, for messages: 2e-05.
std::string shortNumber(double value, int digits = 6);

}  // namespace microinjection
