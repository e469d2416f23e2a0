#include "cell/family/family_cell.h"

#include <filesystem>
#include <sstream>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "cell/family/family_file.h"
#include "cell/model/similarity.h"

namespace microinjection {
namespace {

/// "tip_radius 0.107 of [0.04, 0.2], ..."
std::string parametersText(const Family& family, const Eigen::VectorXd& coordinates) {
  std::vector<std::string> texts;
  for (int i = 0; i < family.dimension(); ++i) {
    const Family::Parameter& parameter = family.parameters()[i];
    texts.push_back(parameter.text(parameter.value(coordinates[i])));
  }
  return join(texts, ", ");
}

std::string describe(const Family& family, const Eigen::VectorXd& coordinates, const SurrogateData& cell) {
  std::ostringstream out;
  out.precision(2);
  out << "family " << family.name() << ": " << parametersText(family, coordinates) << "; expected force error: median "
      << 100 * cell.median_error << " %, nine of ten below " << 100 * cell.common_error << " %; ";
  out.precision(3);
  out << 1e6 * cell.range.depth << " um deep, on the axis " << 1e6 * cell.range.axis_depth << " um";
  return out.str();
}

void append(std::string& reasons, const std::string& reason) {
  if (!reason.empty()) reasons += (reasons.empty() ? "" : "; ") + reason;
}

}  // namespace

std::optional<FamilyCell> makeFamilyCell(const std::shared_ptr<const FamilyData>& family, const Scene& scene,
                                         std::string& reason) {
  reason.clear();
  std::string misfit;
  const auto coordinates = family->family().coordinatesOf(scene, &misfit);
  if (!coordinates) {
    reason = "not of family " + family->family().name() + ": " + misfit;
    return std::nullopt;
  }
  const std::string place = parametersText(family->family(), *coordinates);
  if (!Family::contains(*coordinates)) {
    reason = "outside of family " + family->family().name() + ": " + place;
    return std::nullopt;
  }
  if (!family->isComplete()) {
    reason = "family " + family->family().name() + " has only " + std::to_string(family->members().size()) + " members";
    return std::nullopt;
  }
  if (!family->serves(*coordinates)) {
    const ExpectedError error = family->expectedError(*coordinates);
    std::ostringstream out;
    out.precision(2);
    out << "family " << family->family().name() << " has no converged members enough near " << place
        << " (expected force error: median " << 100 * error.median << " %, nine of ten below " << 100 * error.common
        << " %)";
    reason = out.str();
    return std::nullopt;
  }
  auto data = std::make_shared<SurrogateData>(family->cell(*coordinates));
  const Similarity units = Similarity::of(scene);
  data->changeUnits(units.length, units.energy());
  std::string description = describe(family->family(), *coordinates, *data);
  return FamilyCell{family, std::move(data), std::move(description)};
}

std::optional<FamilyCell> findFamilyCell(const std::string& folder, const Scene& scene, std::string& reason) {
  reason.clear();
  if (folder.empty()) return std::nullopt;
  const std::vector<std::string> files = familyFiles(folder);
  if (files.empty()) {
    reason = std::filesystem::is_directory(folder) ? folder + " has no family: must have files *.yaml"
                                                   : folder + " is no folder: must be that of the families";
    return std::nullopt;
  }
  std::optional<FamilyCell> best;
  std::string misfits;
  for (const std::string& file : files) {
    const Family family = Family::load(file);
    std::string misfit;
    if (!family.coordinatesOf(scene, &misfit)) {
      append(misfits, "family " + family.name() + ": " + misfit);
      continue;
    }
    CacheRead<FamilyData> read = FamilyData::load(family, familyDataFile(file));
    if (!read) {
      append(reason, "family " + family.name() + " has no data (" + read.reason + ")");
      continue;
    }
    std::string own;
    auto cell = makeFamilyCell(std::make_shared<const FamilyData>(std::move(*read.content)), scene, own);
    append(reason, own);
    if (cell && (!best || cell->data->common_error < best->data->common_error)) best = std::move(cell);
  }
  if (!best && reason.empty()) reason = "no family has cells of this form (" + misfits + ")";
  return best;
}

std::string describeFamilyOf(const Scene& scene, const std::string& folder) {
  std::string reason;
  const auto cell = findFamilyCell(folder, scene, reason);
  return cell ? cell->description : "in no family" + (reason.empty() ? "" : ": " + reason);
}

}  // namespace microinjection
