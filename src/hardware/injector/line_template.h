#pragma once

#include <map>
#include <string>
#include <vector>

namespace microinjection {

/// A line with placeholders for numbers, e.g. "P{pressure_hPa:1} {duration_ms}": a name and, after
/// a colon, the format. The format is the number of decimals (0 to 9; default 0), or 0WIDTH.DIGITS
/// as in printf with leading zeros (05.2 writes 1.5 as 01.50). Everything outside of braces is sent
/// unchanged.
class LineTemplate {
 public:
  /// `names`: the allowed names. @throws ConfigError for an unknown name or an invalid placeholder.
  LineTemplate(const std::string& text, const std::vector<std::string>& names);
  LineTemplate() = default;

  std::string fill(const std::map<std::string, double>& values) const;
  bool has(const std::string& name) const { return find(name) != nullptr; }
  /// The value of `name` as rounded in the line; `value` itself if the line does not contain it.
  double rounded(const std::string& name, double value) const;

 private:
  struct Piece {
    std::string text;  ///< sent before the number
    std::string name;  ///< of the number; empty at the end of the line
    int width = 0;     ///< minimum characters, with leading zeros; 0: no minimum
    int decimals = 0;
  };
  static void readFormat(const std::string& line, const std::string& format, Piece& piece);
  const Piece* find(const std::string& name) const;

  std::vector<Piece> pieces_;
};

}  // namespace microinjection
