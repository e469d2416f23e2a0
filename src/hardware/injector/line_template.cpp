#include "hardware/injector/line_template.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <regex>

#include "base/errors.h"
#include "hardware/injector/protocol_placeholders.h"

namespace microinjection {
namespace {

/// Adding 0 turns -0, which devices do not accept, into 0.
double toDecimals(double value, int decimals) {
  const double unit = std::pow(10.0, decimals);
  return std::round(value * unit) / unit + 0.0;
}

std::string written(double value, int width, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%0*.*f", width, decimals, value);
  return text;
}

}  // namespace

void LineTemplate::readFormat(const std::string& line, const std::string& format, Piece& piece) {
  static const std::regex allowed("(?:0([1-9][0-9]?)\\.)?([0-9])");
  std::smatch groups;
  if (!std::regex_match(format, groups, allowed)) {
    throw ConfigError("\"" + line + "\": after a colon stand the decimals, 0 to 9, or 0WIDTH.DIGITS " +
                      "for leading zeros, not \"" + format + "\"");
  }
  if (groups[1].matched) piece.width = std::stoi(groups[1]);
  piece.decimals = std::stoi(groups[2]);
}

LineTemplate::LineTemplate(const std::string& text, const std::vector<std::string>& names) {
  std::size_t from = 0;
  for (std::size_t open; (open = text.find('{', from)) != std::string::npos;) {
    const std::size_t close = text.find('}', open);
    if (close == std::string::npos) throw ConfigError("\"" + text + "\": a { without its }");
    Piece piece{text.substr(from, open - from), text.substr(open + 1, close - open - 1)};
    const std::size_t colon = piece.name.find(':');
    if (colon != std::string::npos) {
      readFormat(text, piece.name.substr(colon + 1), piece);
      piece.name.resize(colon);
    }
    if (std::find(names.begin(), names.end(), piece.name) == names.end()) {
      std::string all;
      for (const std::string& name : names) all += (all.empty() ? "{" : ", {") + name + "}";
      throw ConfigError("\"" + text + "\": {" + piece.name + "} is not one of " + (all.empty() ? "none" : all) +
                        ", and codes/" + piece.name + " is missing");
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
    if (piece.name == kCount) {
      line += kCounts[static_cast<std::size_t>(values.at(kCount))];
    } else if (!piece.name.empty()) {
      line += written(toDecimals(values.at(piece.name), piece.decimals), piece.width, piece.decimals);
    }
  }
  return line;
}

const LineTemplate::Piece* LineTemplate::find(const std::string& name) const {
  for (const Piece& piece : pieces_) {
    if (piece.name == name && !name.empty()) return &piece;
  }
  return nullptr;
}

double LineTemplate::rounded(const std::string& name, double value) const {
  const Piece* const piece = find(name);
  return piece ? toDecimals(value, piece->decimals) : value;
}

}  // namespace microinjection
