#include "cell/identification/record_columns.h"

#include <algorithm>
#include <cctype>
#include <optional>

#include "base/errors.h"
#include "base/lower_case.h"

namespace microinjection {
namespace {

struct Quantity {
  std::string name;
  std::vector<std::string> names;  ///< in order of preference
  std::map<std::string, double> units;
  bool required = false;
};

const std::vector<Quantity>& quantities(RecordKind kind) {
  static const std::map<std::string, double> lengths = {{"m", 1}, {"mm", 1e-3}, {"um", 1e-6}, {"nm", 1e-9}};
  static const std::vector<Quantity> force = {
      {"time", {"time", "t"}, {{"s", 1}, {"ms", 1e-3}, {"us", 1e-6}}},
      {"position", {"tip", "position", "tip_z", "depth", "indentation", "height", "z"}, lengths, true},
      {"deflection", {"deflection"}, lengths},
      {"force",
       {"force", "force_z", "force_axial", "measured_axial", "f"},
       {{"N", 1}, {"mN", 1e-3}, {"uN", 1e-6}, {"nN", 1e-9}, {"pN", 1e-12}},
       true}};
  static const std::vector<Quantity> tongue = {
      {"pressure",
       {"pressure", "suction", "p"},
       {{"Pa", 1}, {"hPa", 100}, {"kPa", 1e3}, {"mbar", 100}, {"mmHg", 133.322}, {"cmH2O", 98.0665}, {"psi", 6894.76}},
       true},
      {"tongue", {"tongue_length", "tongue", "aspirated_length", "projection", "length", "l"}, lengths, true}};
  return kind == RecordKind::kForce ? force : tongue;
}

/// "Height (um)" -> "height", "um"; "force_z_N" -> "force_z", "N".
std::pair<std::string, std::string> split(const std::string& title) {
  std::string words;
  for (const char c : title) {
    const bool separates = std::string(" _([/").find(c) != std::string::npos;
    if (separates && !words.empty() && words.back() != '_') words += '_';
    if (!separates && std::string(")]").find(c) == std::string::npos) words += c;
  }
  const std::size_t last = words.rfind('_');
  if (last == std::string::npos) return {lowerCase(words), ""};
  return {lowerCase(words.substr(0, last)), words.substr(last + 1)};
}

std::string allowed(const Quantity& quantity) {
  std::string text;
  for (const auto& [unit, factor] : quantity.units) text += (text.empty() ? "" : ", ") + unit;
  return text;
}

double unitOf(const Quantity& quantity, std::string unit, const std::string& where) {
  for (const std::string micro : {"\u00B5", "\u03BC"}) {
    if (unit.rfind(micro, 0) == 0) unit = "u" + unit.substr(micro.size());
  }
  const auto found = quantity.units.find(unit);
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

/// "travel, position" is a position, too.
bool isNamed(const std::string& own, const std::string& name) {
  const std::string behind_comma = ",_" + name;
  return own == name || (own.size() > behind_comma.size() &&
                         own.compare(own.size() - behind_comma.size(), std::string::npos, behind_comma) == 0);
}

std::optional<RecordColumn> search(const Quantity& quantity, const TextTable& table) {
  const std::vector<std::string> titles = table.titles();
  for (const std::string& name : quantity.names) {
    for (std::size_t i = 0; i < titles.size(); ++i) {
      if (table.columns[i].clock && quantity.name == "time") return RecordColumn{i, 1, name};
      auto [own, unit] = split(titles[i]);
      if (lowerCase(titles[i]) == name) own = name, unit.clear();
      if (!isNamed(own, name)) continue;
      if (!unit.empty())
        return RecordColumn{i, unitOf(quantity, unit, table.path + ": column '" + titles[i] + "'"), name};
      throw ConfigError(table.path + ": column '" + titles[i] + "': has no unit; give --column " + quantity.name + "=" +
                        titles[i] + ":UNIT, UNIT one of " + allowed(quantity));
    }
  }
  return std::nullopt;
}

/// What is there, for a message.
std::string shown(const TextTable& table) {
  std::string text;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const std::string title = table.titles()[i];
    text += (i == 0 ? "" : ", ") + (title.empty() ? std::to_string(i + 1) : "'" + title + "'");
  }
  return text;
}

/// A column without numbers is none; one that must be there is an error.
bool hasNumbers(const TextTable& table, const Quantity& quantity, const RecordColumn& column) {
  const TextTable::Column& found = table.columns[column.index];
  if (found.numbers > 0) return true;
  if (!quantity.required) return false;
  std::string text = table.path;
  if (found.text_line > 0) text += ", line " + std::to_string(found.text_line);
  throw ConfigError(text + ": column '" + table.titles()[column.index] + "', the " + quantity.name +
                    ", has no numbers" + (found.text.empty() ? "" : ", but '" + found.text + "'"));
}

}  // namespace

std::map<std::string, RecordColumn> findRecordColumns(const TextTable& table, RecordKind kind,
                                                      const std::map<std::string, std::string>& given,
                                                      std::vector<std::string>& notes) {
  std::map<std::string, RecordColumn> columns;
  for (const Quantity& quantity : quantities(kind)) {
    const auto named = given.find(quantity.name);
    std::optional<RecordColumn> found;
    if (named == given.end()) {
      found = search(quantity, table);
    } else {
      const std::string where = "--column " + quantity.name + "=" + named->second;
      const std::size_t colon = named->second.rfind(':');
      if (colon == std::string::npos) throw ConfigError(where + ": must be NAME:UNIT");
      found = RecordColumn{indexOf(named->second.substr(0, colon), table.titles(), where),
                           unitOf(quantity, named->second.substr(colon + 1), where), ""};
    }
    if (!found) continue;
    if (hasNumbers(table, quantity, *found)) {
      columns[quantity.name] = *found;
    } else {
      const std::string& text = table.columns[found->index].text;
      notes.push_back("column '" + table.titles()[found->index] + "', the " + quantity.name + ", has no numbers" +
                      (text.empty() ? "" : ", but '" + text + "',") + " and is left out");
    }
  }
  std::string names;
  for (const Quantity& quantity : quantities(kind)) names += (names.empty() ? "" : ", ") + quantity.name;
  for (const auto& [name, column] : given) {
    const bool known = std::any_of(quantities(kind).begin(), quantities(kind).end(),
                                   [name = name](const Quantity& quantity) { return quantity.name == name; });
    if (!known) throw ConfigError("--column " + name + ": must be one of " + names);
  }
  for (const auto& [name, titles, units, required] : quantities(kind)) {
    if (!required || columns.count(name) > 0) continue;
    const std::string before = table.before.empty() ? "" : " (above it is '" + table.before.substr(0, 60) + "')";
    const std::string titled = table.title_line > 0
                                   ? "line " + std::to_string(table.title_line) + " has the columns " + shown(table)
                                   : "it has no titles before line " + std::to_string(table.first_line) + before +
                                         ", and " + std::to_string(table.columns.size()) + " columns";
    throw ConfigError(table.path + ": has no column of the " + name + ": " + titled + "; name one with --column " +
                      name + "=NAME:UNIT, NAME a title or a number from 1");
  }
  return columns;
}

}  // namespace microinjection
