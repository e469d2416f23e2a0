#pragma once

#include <map>
#include <string>
#include <vector>

namespace microinjection {

/// A line to send with places for numbers, e.g. "P{pressure_hPa:1} {duration_ms:0}\r": a name and, behind a colon, the
/// digits behind the point (0 to 9; none: 0). Everything outside of braces is sent as it is.
class LineTemplate {
 public:
  /// `values`: the names that are allowed. @throws ConfigError for an unknown name or a broken place.
  LineTemplate(const std::string& text, const std::vector<std::string>& names);
  LineTemplate() = default;

  std::string fill(const std::map<std::string, double>& values) const;
  /// The value of `name` as the line says it, rounded; `value` itself where the line does not say it.
  double rounded(const std::string& name, double value) const;

 private:
  struct Piece {
    std::string text;  ///< sent before the number
    std::string name;  ///< of the number; empty for the end of the line
    int decimals = 0;
  };
  std::vector<Piece> pieces_;
};

}  // namespace microinjection
