#include "cell/identification/force_curve.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>

#include "base/errors.h"
#include "cell/identification/force_columns.h"

namespace microinjection {
namespace {

constexpr std::size_t kFewest = 20;  ///< samples
constexpr double kEnd = 0.2;         ///< share of the samples by which sign and direction are judged

std::vector<std::string> splitRow(const std::string& line) {
  const char separator = line.find(',') != std::string::npos    ? ','
                         : line.find(';') != std::string::npos  ? ';'
                         : line.find('\t') != std::string::npos ? '\t'
                                                                : ' ';
  std::vector<std::string> items;
  std::istringstream in(line);
  for (std::string item; std::getline(in, item, separator);) {
    const std::size_t first = item.find_first_not_of(" \t\r\""), last = item.find_last_not_of(" \t\r\"");
    if (first == std::string::npos && separator == ' ') continue;
    items.push_back(first == std::string::npos ? "" : item.substr(first, last - first + 1));
  }
  return items;
}

double number(const std::vector<std::string>& row, const ForceColumn& column) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (column.index >= row.size() || row[column.index].empty()) return kNone;
  char* end = nullptr;
  const double value = std::strtod(row[column.index].c_str(), &end);
  return *end == '\0' ? column.unit * value : kNone;
}

/// Mean of the last samples minus that of the first ones.
double rise(const std::vector<double>& values) {
  const auto count =
      std::max<std::ptrdiff_t>(1, static_cast<std::ptrdiff_t>(kEnd * static_cast<double>(values.size())));
  const auto half = [&](auto from) {
    std::vector<double> part(from, from + count);
    std::nth_element(part.begin(), part.begin() + count / 2, part.end());
    return part[static_cast<std::size_t>(count / 2)];
  };
  return half(values.end() - count) - half(values.begin());
}

void keepFirst(ForceCurve& curve, std::size_t count) {
  for (std::vector<double>* values : {&curve.time, &curve.position, &curve.force}) values->resize(count);
}

/// Both signs follow from the record: the tip goes into the cell, and the cell pushes it back.
void orient(ForceCurve& curve) {
  const auto farthest = std::max_element(curve.position.begin(), curve.position.end(), [&](double a, double b) {
    return std::abs(a - curve.position[0]) < std::abs(b - curve.position[0]);
  });
  if (*farthest < curve.position[0]) {
    for (double& x : curve.position) x = -x;
    curve.notes.emplace_back("the position falls on the way in: its sign is turned");
  }
}

void orientForce(ForceCurve& curve) {
  if (rise(curve.force) >= 0) return;
  for (double& x : curve.force) x = -x;
  curve.notes.emplace_back("the force falls on the way in: its sign is turned");
}

/// Nothing is known about a record that turns back: only the way in is elastic.
void cutRetract(ForceCurve& curve) {
  const auto deepest = std::max_element(curve.position.begin(), curve.position.end());
  const auto count = static_cast<std::size_t>(deepest - curve.position.begin()) + 1;
  if (count == curve.size()) return;
  curve.notes.push_back("the " + std::to_string(curve.size() - count) + " samples behind the deepest one are left out");
  keepFirst(curve, count);
}

}  // namespace

ForceCurve readForceCurve(const std::string& path, const ForceCurveConfig& config) {
  std::ifstream file(path);
  if (!file) throw ConfigError(path + ": cannot be read");
  std::vector<std::string> titles;
  std::map<std::string, ForceColumn> columns;
  ForceCurve curve;
  std::size_t dropped = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.find_first_not_of(" \t\r") == std::string::npos || line[line.find_first_not_of(" \t")] == '#') continue;
    const std::vector<std::string> row = splitRow(line);
    if (titles.empty()) {
      titles = row;
      columns = findForceColumns(titles, config.columns, path);
      curve.timed = columns.count("time") > 0;
      continue;
    }
    const double height = number(row, columns["position"]), force = number(row, columns["force"]);
    const double deflection = columns.count("deflection") > 0 ? number(row, columns["deflection"]) : 0;
    const double time = curve.timed ? number(row, columns["time"]) : static_cast<double>(curve.size());
    if (!std::isfinite(height + force + deflection + time)) {
      ++dropped;
      continue;
    }
    curve.time.push_back(time);
    curve.position.push_back(height - deflection);
    curve.force.push_back(force);
  }
  if (titles.empty()) throw ConfigError(path + ": is empty");
  if (dropped > 0) curve.notes.push_back(std::to_string(dropped) + " rows without numbers are left out");
  if (curve.size() < kFewest) {
    throw ConfigError(path + ": " + std::to_string(curve.size()) + " rows of numbers: must be at least " +
                      std::to_string(kFewest));
  }
  orient(curve);
  if (!config.whole) cutRetract(curve);
  if (curve.size() < kFewest) throw ConfigError(path + ": has no way in: its first samples are its deepest");
  orientForce(curve);
  return curve;
}

ForceCurve averaged(const ForceCurve& curve, std::size_t count) {
  const std::size_t block = (curve.size() + count - 1) / count;
  if (block <= 1) return curve;
  ForceCurve result;
  result.timed = curve.timed;
  result.notes = curve.notes;
  const auto mean = [&](const std::vector<double>& values, std::size_t from) {
    double sum = 0;
    for (std::size_t i = from; i < from + block; ++i) sum += values[i];
    return sum / static_cast<double>(block);
  };
  for (std::size_t from = 0; from + block <= curve.size(); from += block) {
    result.time.push_back(mean(curve.time, from));
    result.position.push_back(mean(curve.position, from));
    result.force.push_back(mean(curve.force, from));
  }
  return result;
}

}  // namespace microinjection
