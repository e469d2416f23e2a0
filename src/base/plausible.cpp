#include "base/plausible.h"

#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

namespace microinjection {
namespace {

constexpr Range kWritten{1e-3, 1e5};  // sizes of numbers in a unit that is made for them

struct Unit {
  std::string name;
  double size;  ///< in SI units
};

/// Units in which people write the quantity, the most usual first.
std::vector<Unit> usualUnits(const std::string& unit) {
  if (unit.empty()) return {{"%", 1e-2}};
  if (unit == "rad") return {{"degrees", std::acos(-1.0) / 180}};
  if (unit == "Pa") return {{"kPa", 1e3}, {"MPa", 1e6}, {"GPa", 1e9}};
  const Unit micro{"u" + unit, 1e-6}, nano{"n" + unit, 1e-9}, milli{"m" + unit, 1e-3}, pico{"p" + unit, 1e-12};
  if (unit == "m" || unit == "m/s" || unit == "N") return {micro, nano, milli, pico};
  return {milli, micro, nano};
}

/// As a person writes it: 5e-3, not 0.005; 1e-6, not 1e-06.
std::string shortText(double value) {
  std::ostringstream out;
  const double size = std::abs(value);
  if (size == 0 || (size >= 0.01 && size < 1e4)) {
    out.precision(4);
    out << value;
    return out.str();
  }
  const int power = static_cast<int>(std::floor(std::log10(size) + 1e-9));
  out.precision(4);
  out << value / std::pow(10, power) << 'e' << power;
  return out.str();
}

}  // namespace

std::string unitSlip(double factor, const std::string& unit) {
  for (const auto& [prefix, size] : {std::pair("m", 1e3), {"u", 1e6}, {"n", 1e9}}) {
    if (factor > 0.03 * size && factor < 30 * size) return prefix + unit + " for " + unit + "?";
  }
  return "";
}

std::string PlausibleRange::allowed(double value) const {
  const std::string low = shortText(range.low), high = shortText(range.high), of_unit = *unit ? " " : "";
  std::string text = range.low_open ? "above " + low + " and " + (range.high_open ? "below " : "at most ") + high
                                    : low + " .. " + high;
  text += of_unit + unit;
  if (range.contains(value) || !kWritten.contains(std::abs(value))) return text;
  for (const Unit& usual : usualUnits(unit)) {
    const double meant = value * usual.size;
    if (range.contains(meant))
      return text + "; " + shortText(value) + " " + usual.name + " would be " + shortText(meant);
  }
  return text;
}

void PlausibleRange::require(const std::string& key, double value, ConfigErrors& errors) const {
  errors.require(range.contains(value), key, value, *unit ? std::string(" ") + unit : "", allowed(value));
}

}  // namespace microinjection
