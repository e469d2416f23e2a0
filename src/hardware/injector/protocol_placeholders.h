#pragma once

#include <string>
#include <vector>

namespace microinjection {

/// A placeholder for a number in a line, and the unit of the number: SI value = number * unit +
/// zero.
struct Placeholder {
  std::string name;
  double unit;      ///< Pa or s
  double zero = 0;  ///< Pa, gauge

  double toUnit(double value) const { return (value - zero) / unit; }
};

/// `unit` (Pa) and `zero` (Pa, gauge) are those of {pressure}, the device's own.
inline std::vector<Placeholder> pressurePlaceholders(double unit, double zero) {
  constexpr double kPsi = 6894.757293168;  // Pa
  return {{"pressure_Pa", 1},
          {"pressure_hPa", 100},
          {"pressure_kPa", 1000},
          {"pressure_psi", kPsi},
          {"pressure", unit, zero}};
}

inline std::vector<Placeholder> durationPlaceholders() { return {{"duration_s", 1}, {"duration_ms", 1e-3}}; }

/// A character that differs in successive lines, so that a late answer does not confirm a later line;
/// 0 in the guarded stop. Without the letters that are commands of an Arduino, which takes a command
/// whose begin was lost for another one.
constexpr char kCount[] = "count";
constexpr char kCounts[] = "0123456789ABDEFGHIJKLMNOPQRSTUVWXYZadefghijklmnopqrstuvwyz";
constexpr char kLine[] = "line";  ///< to confirm: the line itself

inline std::vector<std::string> names(const std::vector<Placeholder>& placeholders) {
  std::vector<std::string> all;
  for (const Placeholder& placeholder : placeholders) all.push_back(placeholder.name);
  return all;
}

}  // namespace microinjection
