#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/errors.h"
#include "base/worker_processes.h"
#include "cell/family/family_check.h"
#include "cell/family/family_file.h"
#include "commands/path_store.h"
#include "commands/prepare_family.h"
#include "commands/solve_paths.h"

namespace microinjection {
namespace {

constexpr double kLargeForce = 0.02;  ///< of the member's largest: the error of smaller ones is not counted

FamilyData loadData(const Family& family, const std::string& file) {
  auto read = FamilyData::load(family, familyDataFile(file));
  if (!read) throw ConfigError(read.reason + "; make the data with: prepare --family " + file);
  return std::move(*read.content);
}

PathStore storeOf(const Family& family, const Eigen::VectorXd& coordinates, int seed) {
  return {family.member(coordinates), drawMotions(family, coordinates, seed)};
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) throw std::runtime_error("no place of the check has a converged force");
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace

void checkFamily(const FamilyArguments& arguments) {
  const Family family = Family::load(arguments.file);
  const FamilyData data = loadData(family, arguments.file);
  const std::vector<Eigen::VectorXd> members = drawMembers(family, arguments.check, arguments.seed);
  std::vector<PathStore> stores;
  for (std::size_t i = 0; i < members.size(); ++i) {
    stores.push_back(storeOf(family, members[i], arguments.seed + static_cast<int>(i)));
  }
  solvePaths("prepare: " + std::to_string(members.size()) + " members never solved for", arguments.jobs, [&] {
    std::vector<std::vector<std::string>> commands;
    for (std::size_t i = 0; i < members.size(); ++i) {
      for (const std::size_t ray : stores[i].missing()) {
        commands.push_back({thisProgram(), "--family", arguments.file, "--check", std::to_string(arguments.check),
                            "--seed", std::to_string(arguments.seed), "--member", std::to_string(i), "--ray",
                            std::to_string(ray)});
      }
    }
    return commands;
  });
  std::ostringstream table;
  table << "family,member,angle,depth,lateral,force_error,surface_error,force_share\n";
  std::vector<double> forces, surfaces;
  for (std::size_t i = 0; i < members.size(); ++i) {
    for (const CheckedPlace& place : compareMember(data, members[i], stores[i].plan(), stores[i].loadAll())) {
      char row[200];
      std::snprintf(row, sizeof(row), "%s,%zu,%.1f,%.3f,%.3f,%.5f,%.5f,%.3f\n", family.name().c_str(), i,
                    place.angle * 57.29578, place.depth, place.lateral, place.force_error, place.surface_error,
                    place.force_share);
      table << row;
      surfaces.push_back(place.surface_error);
      if (place.force_share > kLargeForce) forces.push_back(place.force_error);
    }
  }
  if (!arguments.csv.empty()) writeFileAtomically(arguments.csv, table.str());
  std::printf("%s", table.str().c_str());
  std::printf(
      "prepare: %s: force error at %zu places of %zu members: median %.2g %%, nine of ten below %.2g %%, largest %.2g "
      "%%; surface: largest %.2g of the diameter\n",
      family.name().c_str(), forces.size(), members.size(), 100 * quantile(forces, 0.5), 100 * quantile(forces, 0.9),
      100 * quantile(forces, 1), quantile(surfaces, 1));
}

int solveCheckPath(const FamilyArguments& arguments, int member, int ray) {
  const Family family = Family::load(arguments.file);
  const Eigen::VectorXd coordinates = drawMembers(family, arguments.check, arguments.seed).at(member);
  const PathStore store = storeOf(family, coordinates, arguments.seed + member);
  return store.solve(ray) == PathStore::Outcome::kBusy ? kBusyStatus : 0;
}

}  // namespace microinjection
