#include "cell/identification/force_columns.h"

#include <algorithm>
#include <cctype>
#include <optional>

#include "base/errors.h"

namespace microinjection {
namespace {

struct Quantity {
  std::string name;
  std::vector<std::string> names;  ///< in order of preference
  std::map<std::string, double> units;
};

const std::vector<Quantity>& quantities() {
  static const std::map<std::string, double> lengths = {{"m", 1}, {"mm", 1e-3}, {"um", 1e-6}, {"nm", 1e-9}};
  static const std::vector<Quantity> all = {
      {"time", {"time", "t"}, {{"s", 1}, {"ms", 1e-3}, {"us", 1e-6}}},
      {"position", {"tip", "position", "tip_z", "depth", "indentation", "height", "z"}, lengths},
      {"deflection", {"deflection"}, lengths},
      {"force",
       {"force", "force_z", "force_axial", "measured_axial", "f"},
       {{"N", 1}, {"mN", 1e-3}, {"uN", 1e-6}, {"nN", 1e-9}, {"pN", 1e-12}}}};
  return all;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// "Height (um)" -> "height", "um"; "force_z_N" -> "force_z", "N".
std::pair<std::string, std::string> split(const std::string& title) {
  std::string words;
  for (const char c : title) {
    const bool separates = std::string(" _([").find(c) != std::string::npos;
    if (separates && !words.empty() && words.back() != '_') words += '_';
    if (!separates && std::string(")]").find(c) == std::string::npos) words += c;
  }
  const std::size_t last = words.rfind('_');
  if (last == std::string::npos) return {lower(words), ""};
  return {lower(words.substr(0, last)), words.substr(last + 1)};
}

std::string allowed(const Quantity& quantity) {
  std::string text;
  for (const auto& [unit, factor] : quantity.units) text += (text.empty() ? "" : ", ") + unit;
  return text;
}

double unitOf(const Quantity& quantity, const std::string& unit, const std::string& where) {
  const auto found = quantity.units.find(unit == "µm" ? "um" : unit);
  if (found == quantity.units.end())
    throw ConfigError(where + ": unit '" + unit + "': must be one of " + allowed(quantity));
  return found->second;
}

/// Index of the column that is named, or numbered from 1.
std::size_t indexOf(const std::string& wanted, const std::vector<std::string>& titles, const std::string& where) {
  const auto found = std::find(titles.begin(), titles.end(), wanted);
  if (found != titles.end()) return static_cast<std::size_t>(found - titles.begin());
  const bool number = !wanted.empty() && std::all_of(wanted.begin(), wanted.end(), ::isdigit);
  if (number && wanted.size() < 6 && std::stoul(wanted) >= 1 && std::stoul(wanted) <= titles.size())
    return std::stoul(wanted) - 1;
  throw ConfigError(where + ": the file has no column '" + wanted + "'");
}

std::optional<ForceColumn> search(const Quantity& quantity, const std::vector<std::string>& titles,
                                  const std::string& path) {
  for (const std::string& name : quantity.names) {
    for (std::size_t i = 0; i < titles.size(); ++i) {
      const auto [own, unit] = split(titles[i]);
      if (own == name && !unit.empty())
        return ForceColumn{i, unitOf(quantity, unit, path + ": column '" + titles[i] + "'")};
      if (own != name || !unit.empty()) continue;
      throw ConfigError(path + ": column '" + titles[i] + "': has no unit; give --column " + quantity.name + "=" +
                        titles[i] + ":UNIT, UNIT one of " + allowed(quantity));
    }
  }
  return std::nullopt;
}

}  // namespace

std::map<std::string, ForceColumn> findForceColumns(const std::vector<std::string>& titles,
                                                    const std::map<std::string, std::string>& given,
                                                    const std::string& path) {
  std::map<std::string, ForceColumn> columns;
  for (const Quantity& quantity : quantities()) {
    const auto named = given.find(quantity.name);
    if (named == given.end()) {
      if (const auto found = search(quantity, titles, path)) columns[quantity.name] = *found;
      continue;
    }
    const std::string where = "--column " + quantity.name + "=" + named->second;
    const std::size_t colon = named->second.rfind(':');
    if (colon == std::string::npos) throw ConfigError(where + ": must be NAME:UNIT");
    columns[quantity.name] = {indexOf(named->second.substr(0, colon), titles, where),
                              unitOf(quantity, named->second.substr(colon + 1), where)};
  }
  for (const auto& [name, column] : given) {
    if (columns.count(name) == 0) {
      throw ConfigError("--column " + name + ": must be one of time, position, deflection, force");
    }
  }
  for (const char* name : {"position", "force"}) {
    if (columns.count(name) == 0) {
      throw ConfigError(path + ": has no column of the " + name + "; name one with --column " + name + "=NAME:UNIT");
    }
  }
  return columns;
}

}  // namespace microinjection
