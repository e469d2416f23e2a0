#pragma once

#include <string>
#include <vector>

namespace microinjection {

/// A place for a number in a line, and the unit that the number has there: SI value = number * unit + zero.
struct Place {
  std::string name;
  double unit;      ///< Pa or s
  double zero = 0;  ///< Pa, gauge

  double toUnit(double value) const { return (value - zero) / unit; }
};

/// `unit` (Pa) and `zero` (Pa, gauge) are those of {pressure}, the device's own.
inline std::vector<Place> pressurePlaces(double unit, double zero) {
  constexpr double kPsi = 6894.757293168;  // Pa
  return {{"pressure_Pa", 1},
          {"pressure_hPa", 100},
          {"pressure_kPa", 1000},
          {"pressure_psi", kPsi},
          {"pressure", unit, zero}};
}

inline std::vector<Place> durationPlaces() { return {{"duration_s", 1}, {"duration_ms", 1e-3}}; }

inline std::vector<std::string> names(const std::vector<Place>& places) {
  std::vector<std::string> all;
  for (const Place& place : places) all.push_back(place.name);
  return all;
}

}  // namespace microinjection
