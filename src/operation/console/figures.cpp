#include "operation/console/figures.h"

#include <cmath>
#include <cstdio>

namespace microinjection {

std::string figure(double value, double unit, int decimals) {
  if (!std::isfinite(value)) return "-";
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value / unit);
  return text;
}

}  // namespace microinjection
