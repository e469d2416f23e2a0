#pragma once

#include <limits>
#include <string>

namespace microinjection {

/// Closed, half-open or open interval of allowed values, and its text in messages.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;

  static Range positive() { return {0, std::numeric_limits<double>::infinity(), true, true}; }
  static Range nonNegative() { return {0, std::numeric_limits<double>::infinity(), false, true}; }
  static Range closed(double low, double high) { return {low, high, false, false}; }
  static Range open(double low, double high) { return {low, high, true, true}; }
  static Range finite() { return {}; }

  bool contains(double value) const;  ///< false for NaN and infinities
  std::string text() const;           ///< for example "(0, inf)" or "[0, 0.5)"
};

}  // namespace microinjection
