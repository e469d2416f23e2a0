#include "session/rounded_parameter.h"

#include <cstdio>
#include <cstdlib>

namespace microinjection {

std::string shortNumber(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

double roundedParameter(double value) { return std::strtod(shortNumber(value).c_str(), nullptr); }

}  // namespace microinjection
