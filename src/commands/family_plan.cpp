#include "commands/family_plan.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "base/atomic_file.h"
#include "base/cache_file.h"
#include "base/errors.h"
#include "base/parse_number.h"
#include "base/separated.h"

namespace microinjection {
namespace {

constexpr char kColumns[] = "task,kind,coordinates,piece";
constexpr char kChecksum[] = ", checksum ";
constexpr char kAxis[] = "axis", kPath[] = "path";

}  // namespace

std::string coordinatesText(const Eigen::VectorXd& coordinates, char separator) {
  std::ostringstream out;
  for (Eigen::Index i = 0; i < coordinates.size(); ++i) {
    if (i > 0) out << separator;
    out << coordinates[i];
  }
  return out.str();
}

std::optional<Eigen::VectorXd> parseCoordinates(const std::string& text, char separator) {
  const std::vector<std::string> parts = text.empty() ? std::vector<std::string>() : separated(text, separator);
  Eigen::VectorXd coordinates(static_cast<Eigen::Index>(parts.size()));
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto number = parseNumber<double>(parts[i]);
    if (!number) return std::nullopt;
    coordinates[static_cast<Eigen::Index>(i)] = *number;
  }
  return coordinates;
}

void FamilyPlan::addAxisNodes(int nodes) {
  for (int node = 0; node < nodes; ++node) tasks_.push_back({{}, node});
}

void FamilyPlan::addMember(const Eigen::VectorXd& coordinates, std::size_t paths) {
  members_.push_back(coordinates);
  for (std::size_t i = 0; i < paths; ++i) tasks_.push_back({coordinates, static_cast<int>(i)});
}

std::string FamilyPlan::headStart() const { return "# a round of prepare --family " + name_ + " --members "; }

std::string FamilyPlan::head(const std::string& body) const {
  const std::string wanted = std::to_string(wanted_);
  return headStart() + wanted + kChecksum + contentHash(family_ + wanted + body);
}

void FamilyPlan::save(const std::string& file) const {
  std::ostringstream body;
  body << kColumns << '\n';
  for (std::size_t i = 0; i < tasks_.size(); ++i) {
    const Task& task = tasks_[i];
    const bool axis = task.coordinates.size() == 0;
    body << i << ',' << (axis ? kAxis : kPath) << ',' << coordinatesText(task.coordinates, ' ') << ',' << task.piece
         << '\n';
  }
  writeFileAtomically(file, head(body.str()) + "\n" + body.str());
}

void FamilyPlan::load(const std::string& file) {
  std::ifstream in(file);
  std::string first, row;
  if (!in || !std::getline(in, first)) throw ConfigError(file + ": cannot be read; make it with --list");
  std::ostringstream rest;
  rest << in.rdbuf();
  const std::size_t start = headStart().size(), end = std::min(first.rfind(kChecksum), first.size());
  const auto wanted = end > start ? parseNumber<int>(first.substr(start, end - start)) : std::nullopt;
  wanted_ = wanted.value_or(0);
  if (first != head(rest.str())) {
    throw ConfigError(file + ": is damaged, or of another family; make it with --list");
  }
  std::istringstream rows(rest.str());
  std::getline(rows, row);  // the columns' names
  while (std::getline(rows, row)) {
    const std::vector<std::string> fields = separated(row);
    const auto piece = fields.size() == 4 ? parseNumber<int>(fields[3]) : std::nullopt;
    const auto coordinates = piece ? parseCoordinates(fields[2], ' ') : std::nullopt;
    if (!coordinates) throw ConfigError(file + ": '" + row + "' is no task");
    const bool member = coordinates->size() > 0;
    const bool known = std::find(members_.begin(), members_.end(), *coordinates) != members_.end();
    if (member && !known) members_.push_back(*coordinates);
    tasks_.push_back({*coordinates, *piece});
  }
}

}  // namespace microinjection
