#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/errors.h"
#include "base/worker_processes.h"
#include "cell/family/family_check.h"
#include "cell/family/family_file.h"
#include "cell/family/family_reference.h"
#include "commands/path_store.h"
#include "commands/prepare_family.h"
#include "commands/run_tasks.h"

namespace microinjection {
namespace {

constexpr double kLargeForce = 0.02;  ///< of the member's largest: the error of smaller ones is not counted

FamilyData loadData(const Family& family, const std::string& file) {
  auto read = FamilyData::load(family, familyDataFile(file));
  if (!read) throw ConfigError(read.reason + "; make the data with: prepare --family " + file);
  return std::move(*read.content);
}

PathStore storeOfDrawnMotions(const Family& family, const Eigen::VectorXd& coordinates, int seed) {
  return {family.member(coordinates), drawMotions(family, coordinates, seed)};
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) throw std::runtime_error("no place of the check has a converged force");
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

class FamilyCheck {
 public:
  explicit FamilyCheck(const FamilyArguments& arguments)
      : arguments_(arguments),
        family_(Family::load(arguments.file)),
        data_(loadData(family_, arguments.file)),
        members_(drawMembers(family_, arguments.check, arguments.seed)) {
    if (arguments_.reference.empty()) return;
    places_ = readReferences(family_, arguments_.seed, arguments_.reference);
    requireWritableFolder(std::filesystem::absolute(arguments_.reference).parent_path());
  }

  void run() {
    std::vector<int> missing;
    for (int member = 0; member < arguments_.check; ++member) {
      const bool known =
          std::any_of(places_.begin(), places_.end(), [&](const auto& at) { return at.member == member; });
      if (!known) missing.push_back(member);
    }
    // Some at a time: an interruption then loses few of them.
    for (std::size_t i = 0; i < missing.size(); i += kBatch) {
      solve({missing.begin() + static_cast<std::ptrdiff_t>(i),
             missing.begin() + static_cast<std::ptrdiff_t>(std::min(i + kBatch, missing.size()))});
    }
    report();
  }

 private:
  static constexpr std::size_t kBatch = 3;

  void solve(const std::vector<int>& batch) {
    std::vector<PathStore> stores;
    for (const int member : batch)
      stores.push_back(storeOfDrawnMotions(family_, members_[member], arguments_.seed + member));
    const std::string title = "prepare: members " + std::to_string(batch.front() + 1) + " to " +
                              std::to_string(batch.back() + 1) + " of " + std::to_string(arguments_.check) +
                              ", never solved for";
    runTasks(title, "paths", arguments_.jobs, [&] {
      std::vector<Work> commands;
      for (std::size_t i = 0; i < batch.size(); ++i) {
        for (const std::size_t ray : stores[i].missing()) {
          commands.push_back(
              {{thisProgram(), "--family", arguments_.file, "--check", std::to_string(arguments_.check), "--seed",
                std::to_string(arguments_.seed), "--member", std::to_string(batch[i]), "--ray", std::to_string(ray)}});
        }
      }
      return commands;
    });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const auto solved = referencePlaces(batch[i], members_[batch[i]], stores[i].plan(), stores[i].loadAll());
      places_.insert(places_.end(), solved.begin(), solved.end());
    }
    if (arguments_.reference.empty()) return;
    writeFileAtomically(arguments_.reference, writeReferences(family_, arguments_.seed, places_));
  }

  void report() {
    std::ostringstream table;
    table << "family,member,angle,depth,lateral,force_error,surface_error,force_share\n";
    std::vector<double> forces, surfaces;
    std::set<int> members;
    for (const CheckedPlace& place : comparePlaces(data_, places_)) {
      char row[200];
      std::snprintf(row, sizeof(row), "%s,%d,%.1f,%.3f,%.3f,%.5f,%.5f,%.3f\n", family_.name().c_str(), place.member,
                    place.angle * 57.29578, place.depth, place.lateral, place.force_error, place.surface_error,
                    place.force_share);
      table << row;
      members.insert(place.member);
      surfaces.push_back(place.surface_error);
      if (place.force_share > kLargeForce) forces.push_back(place.force_error);
    }
    if (!arguments_.csv.empty()) writeFileAtomically(arguments_.csv, table.str());
    std::printf("%s", table.str().c_str());
    if (arguments_.record) record({quantile(forces, 0.5), quantile(forces, 0.9)}, members);
    std::printf(
        "prepare: %s: force error at %zu places of %zu members: median %.2g %%, nine of ten below %.2g %%, largest "
        "%.2g %%; surface: largest %.2g of the diameter\n",
        family_.name().c_str(), forces.size(), members.size(), 100 * quantile(forces, 0.5), 100 * quantile(forces, 0.9),
        100 * quantile(forces, 1), quantile(surfaces, 1));
  }

  void record(const ExpectedError& error, const std::set<int>& compared) {
    std::vector<Eigen::VectorXd> coordinates;
    for (const int member : compared) coordinates.push_back(members_.at(static_cast<std::size_t>(member)));
    data_.setMeasuredError(error, coordinates);
    data_.save(familyDataFile(arguments_.file));
  }

  FamilyArguments arguments_;
  Family family_;
  FamilyData data_;
  std::vector<Eigen::VectorXd> members_;
  std::vector<ReferencePlace> places_;
};

}  // namespace

void checkFamily(const FamilyArguments& arguments) { FamilyCheck(arguments).run(); }

int solveCheckPath(const FamilyArguments& arguments, int member, int ray) {
  const Family family = Family::load(arguments.file);
  const Eigen::VectorXd coordinates = drawMembers(family, arguments.check, arguments.seed).at(member);
  const PathStore store = storeOfDrawnMotions(family, coordinates, arguments.seed + member);
  return store.solve(ray) == PathStore::Outcome::kBusy ? kBusyStatus : 0;
}

}  // namespace microinjection
