#pragma once

#include <map>
#include <string>
#include <vector>

namespace microinjection {

/// A line to send with places for numbers, e.g. "P{pressure_hPa:1} {duration_ms}": a name and, behind a colon, how the
/// number is written: the digits behind the point (0 to 9; none: 0), or as printf has it with leading zeros,
/// 0WIDTH.DIGITS (05.2 writes 1.5 as 01.50). Everything outside of braces is sent as it is.
class LineTemplate {
 public:
  /// `values`: the names that are allowed. @throws ConfigError for an unknown name or a broken place.
  LineTemplate(const std::string& text, const std::vector<std::string>& names);
  LineTemplate() = default;

  std::string fill(const std::map<std::string, double>& values) const;
  bool has(const std::string& name) const { return find(name) != nullptr; }
  /// The value of `name` as the line says it, rounded; `value` itself where the line does not say it.
  double rounded(const std::string& name, double value) const;

 private:
  struct Piece {
    std::string text;  ///< sent before the number
    std::string name;  ///< of the number; empty for the end of the line
    int width = 0;     ///< characters at least, with leading zeros; 0: as many as it takes
    int decimals = 0;
  };
  static void readFormat(const std::string& line, const std::string& format, Piece& piece);
  const Piece* find(const std::string& name) const;

  std::vector<Piece> pieces_;
};

}  // namespace microinjection
