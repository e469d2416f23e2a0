#include "injector/line_template.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/errors.h"

namespace microinjection {
namespace {

std::string withDecimals(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  // "-0" is no number of a device.
  const std::string written(text);
  return written.find_first_not_of("-0.") == std::string::npos && written[0] == '-' ? written.substr(1) : written;
}

}  // namespace

LineTemplate::LineTemplate(const std::string& text, const std::vector<std::string>& names) {
  std::size_t from = 0;
  for (std::size_t open; (open = text.find('{', from)) != std::string::npos;) {
    const std::size_t close = text.find('}', open);
    if (close == std::string::npos) throw ConfigError("\"" + text + "\": a { without its }");
    Piece piece{text.substr(from, open - from), text.substr(open + 1, close - open - 1)};
    const std::size_t colon = piece.name.find(':');
    if (colon != std::string::npos) {
      const std::string digits = piece.name.substr(colon + 1);
      if (digits.size() != 1 || digits[0] < '0' || digits[0] > '9') {
        throw ConfigError("\"" + text + "\": behind a colon stands one digit, 0 to 9, not \"" + digits + "\"");
      }
      piece.decimals = digits[0] - '0';
      piece.name.resize(colon);
    }
    if (std::find(names.begin(), names.end(), piece.name) == names.end()) {
      std::string all;
      for (const std::string& name : names) all += (all.empty() ? "{" : ", {") + name + "}";
      throw ConfigError("\"" + text + "\": {" + piece.name + "} is not one of " + (all.empty() ? "none" : all));
    }
    pieces_.push_back(piece);
    from = close + 1;
  }
  pieces_.push_back({text.substr(from), ""});
}

std::string LineTemplate::fill(const std::map<std::string, double>& values) const {
  std::string line;
  for (const Piece& piece : pieces_) {
    line += piece.text;
    if (!piece.name.empty()) line += withDecimals(values.at(piece.name), piece.decimals);
  }
  return line;
}

double LineTemplate::rounded(const std::string& name, double value) const {
  for (const Piece& piece : pieces_) {
    if (piece.name != name) continue;
    const double unit = std::pow(10.0, piece.decimals);
    return std::round(value * unit) / unit;
  }
  return value;
}

}  // namespace microinjection
