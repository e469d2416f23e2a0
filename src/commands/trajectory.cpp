#include "commands/trajectory.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>

#include "base/errors.h"
#include "base/separated.h"

namespace microinjection {
namespace {

/// Indices of the columns that are used.
struct Columns {
  std::size_t x, y, z, force, in_contact;
  std::optional<std::size_t> punctured;

  Columns(const std::vector<std::string>& header, const std::string& path) {
    const auto find = [&](const std::string& name) {
      const auto found = std::find(header.begin(), header.end(), name);
      if (found == header.end()) throw ConfigError(path + ": has no column " + name);
      return static_cast<std::size_t>(found - header.begin());
    };
    x = find("tip_x_m");
    y = find("tip_y_m");
    z = find("tip_z_m");
    force = find("predicted_axial_N");
    in_contact = find("in_contact");
    if (std::find(header.begin(), header.end(), "punctured") != header.end()) punctured = find("punctured");
  }
  std::size_t last() const { return std::max({x, y, z, force, in_contact}); }
};

double number(const std::string& cell, const std::string& path) {
  std::istringstream stream(cell);
  double value = 0;
  if (!(stream >> value) || !stream.eof()) throw ConfigError(path + ": '" + cell + "' is not a number");
  return value;
}

/// Ends the contact at its deepest point.
void cutAtDeepest(std::vector<ContactSample>& contact) {
  const auto deepest = std::min_element(contact.begin(), contact.end(),
                                        [](const auto& a, const auto& b) { return a.tip.z() < b.tip.z(); });
  if (deepest != contact.end()) contact.erase(deepest + 1, contact.end());
}

/// Ends the contact at its largest force.
void cutAtPuncture(std::vector<ContactSample>& contact) {
  const auto largest = std::max_element(contact.begin(), contact.end(),
                                        [](const auto& a, const auto& b) { return a.axial_force < b.axial_force; });
  if (largest != contact.end()) contact.erase(largest + 1, contact.end());
}

double depth(const std::vector<ContactSample>& path) {
  return path.empty() ? 0 : path.front().tip.z() - path.back().tip.z();
}

}  // namespace

std::vector<ContactSample> readIndentationPath(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) throw ConfigError(path + ": cannot be read");
  const Columns columns(separated(line), path);
  std::vector<ContactSample> longest, contact;
  const auto end = [&] {
    cutAtDeepest(contact);
    if (depth(contact) > depth(longest)) longest = contact;
    contact.clear();
  };
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = separated(line);
    const std::size_t flag = columns.punctured.value_or(0);
    if (columns.punctured && cells.size() > flag && cells[flag] == "1") {
      cutAtPuncture(contact);
      break;  // the cell stays punctured
    }
    const bool touching = cells.size() > columns.last() && cells[columns.in_contact] == "1";
    if (!touching) {
      end();
      continue;
    }
    if (cells[columns.force].empty() || cells[columns.z].empty()) continue;
    ContactSample sample;
    sample.tip = {number(cells[columns.x], path), number(cells[columns.y], path), number(cells[columns.z], path)};
    sample.axial_force = number(cells[columns.force], path);
    contact.push_back(sample);
  }
  end();
  if (longest.size() < 2) throw ConfigError(path + ": the tip never went into the cell");
  return longest;
}

std::vector<ContactSample> thinOut(const std::vector<ContactSample>& path, int count) {
  std::vector<ContactSample> result;
  const double top = path.front().tip.z(), all = depth(path);
  for (const ContactSample& sample : path) {
    const double wanted = all * static_cast<double>(result.size() + 1) / count;
    if (static_cast<int>(result.size()) < count && top - sample.tip.z() >= wanted * (1 - 1e-12)) {
      result.push_back(sample);
    }
  }
  return result;
}

}  // namespace microinjection
