#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace microinjection {

/// A part of the hand's way.
struct Waypoint {
  const char* phase;
  double duration, z;  ///< s, m of the hand
  bool clutch;
};

/// The hand indents, punctures, injects and retracts.
inline const std::vector<Waypoint> kHandPath = {
    {"approach", 2.0, -19.2e-3, false}, {"approach", 0.2, -19.2e-3, true},  {"approach", 1.2, 0, true},
    {"approach", 0.2, 0, false},        {"approach", 1.6, -10.8e-3, false}, {"touch", 1.0, -13.8e-3, false},
    {"indent", 0.4, -16.8e-3, false},   {"hold", 0.2, -16.8e-3, false},     {"puncture", 0.8, -24.8e-3, false},
    {"puncture", 0.5, -24.8e-3, false}, {"inject", 0.6, -24.8e-3, false},   {"retract", 1.2, -10.8e-3, false},
    {"retract", 1.0, 0, false}};

/// A motion for the node virtual_hand. @returns the path
inline std::string writeMotion(const std::filesystem::path& path, const std::vector<Waypoint>& way) {
  std::ofstream out(path);
  out << "path:\n";
  for (const Waypoint& point : way)
    out << "  - {phase: " << point.phase << ", duration: " << point.duration << ", z: " << point.z
        << ", clutch: " << (point.clutch ? "true" : "false") << "}\n";
  return path.string();
}

inline std::string readFile(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("there is no file " + path.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Of a cell of a table. @throws std::runtime_error when it has none
inline double toNumber(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0') throw std::runtime_error("no number: " + text);
  return value;
}

/// A table of a session, by the names of its columns.
class CsvRows {
 public:
  using Row = std::map<std::string, std::string>;

  /// @throws std::runtime_error when a row is cut
  explicit CsvRows(const std::string& text) {
    if (text.empty() || text.back() != '\n') throw std::runtime_error("the last row is cut");
    std::istringstream lines(text);
    std::string line;
    std::getline(lines, line);
    const std::vector<std::string> names = split(line);
    while (std::getline(lines, line)) {
      const std::vector<std::string> values = split(line);
      if (values.size() != names.size()) throw std::runtime_error("a row is cut: " + line);
      rows_.emplace_back();
      for (std::size_t i = 0; i < names.size(); ++i) rows_.back()[names[i]] = values[i];
    }
  }

  const std::vector<Row>& all() const { return rows_; }

 private:
  static std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> parts;
    for (std::size_t begin = 0; begin <= line.size();) {
      const std::size_t comma = std::min(line.find(',', begin), line.size());
      parts.push_back(line.substr(begin, comma - begin));
      begin = comma + 1;
    }
    return parts;
  }

  std::vector<Row> rows_;
};

}  // namespace microinjection
