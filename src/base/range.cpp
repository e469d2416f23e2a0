#include "base/range.h"

#include <cmath>
#include <sstream>

namespace microinjection {

bool Range::contains(double value) const {
  if (!std::isfinite(value)) return false;
  return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
}

std::string Range::text() const {
  std::ostringstream out;
  const bool open_low = low_open || std::isinf(low), open_high = high_open || std::isinf(high);
  out << (open_low ? '(' : '[') << low << ", " << high << (open_high ? ')' : ']');
  return out.str();
}

}  // namespace microinjection
