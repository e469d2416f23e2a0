#include "commands/prepare_family.h"

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <sstream>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/errors.h"
#include "base/worker_processes.h"
#include "cell/family/family_data.h"
#include "cell/family/family_file.h"
#include "cell/family/next_members.h"
#include "commands/axis_store.h"
#include "commands/path_store.h"
#include "commands/solve_paths.h"

namespace microinjection {
namespace {

constexpr int kRound = 4;  ///< members that are solved before the next are chosen

std::string text(const Eigen::VectorXd& coordinates) {
  std::ostringstream out;
  for (Eigen::Index i = 0; i < coordinates.size(); ++i) out << (i > 0 ? "," : "") << coordinates[i];
  return out.str();
}

Eigen::VectorXd parse(const std::string& coordinates, int dimension) {
  std::vector<double> values;
  std::istringstream in(coordinates);
  for (std::string item; std::getline(in, item, ',');) values.push_back(std::stod(item));
  if (static_cast<int>(values.size()) != dimension)
    throw ConfigError("--at = " + coordinates + ": wrong number of values");
  return Eigen::Map<const Eigen::VectorXd>(values.data(), dimension);
}

PathStore storeOf(const Family& family, const Eigen::VectorXd& coordinates) {
  const Scene member = family.member(coordinates);
  return {member, planMember(family, member)};
}

class FamilyPreparation {
 public:
  explicit FamilyPreparation(const FamilyArguments& arguments)
      : arguments_(arguments),
        family_(Family::load(arguments.file)),
        path_(familyDataFile(arguments.file)),
        data_(family_) {
    requireWritableFolder(std::filesystem::absolute(path_).parent_path());
    reload();
  }

  void run() {
    if (arguments_.refit) {
      std::printf("prepare: %d members fitted anew\n", data_.refit());
      store();
    }
    solveAxisForces();
    while (count() < arguments_.members) {
      const int round = std::min(kRound, arguments_.members - count());
      solve(nextMembers(data_.knownPoints(), lengths(), round));
    }
    if (axis_forces_.size() > 0 && !data_.hasAxisCurves()) store();
    report();
  }

 private:
  int count() const { return static_cast<int>(data_.members().size() + data_.failed().size()); }

  Eigen::VectorXd lengths() const {
    return data_.members().empty() ? Eigen::VectorXd::Constant(family_.dimension(), 2) : data_.covariance().lengths;
  }

  void reload() {
    auto read = FamilyData::load(family_, path_);
    if (read) data_ = std::move(*read.content);
    reportDamage(read.state, read.reason);
  }

  void solveAxisForces() {
    const AxisStore store(family_);
    if (data_.hasAxisCurves()) return;
    solvePaths("prepare: forces on the axis", arguments_.jobs, [&] {
      std::vector<std::vector<std::string>> commands;
      for (const int node : store.missing()) {
        commands.push_back({thisProgram(), "--family", arguments_.file, "--axis", std::to_string(node)});
      }
      return commands;
    });
    axis_forces_ = store.loadAll();
    if (axis_forces_.size() == 0) {
      std::printf("prepare: some members have no solution on the axis: its force is interpolated between members\n");
    }
  }

  void solve(const std::vector<Eigen::VectorXd>& next) {
    std::vector<PathStore> stores;
    for (const Eigen::VectorXd& coordinates : next) stores.push_back(storeOf(family_, coordinates));
    const std::string title = "prepare: members " + std::to_string(count() + 1) + " to " +
                              std::to_string(count() + next.size()) + " of " + std::to_string(arguments_.members);
    solvePaths(title, arguments_.jobs, [&] {
      std::vector<std::vector<std::string>> commands;
      for (std::size_t i = 0; i < next.size(); ++i) {
        for (const std::size_t ray : stores[i].missing()) {
          commands.push_back(
              {thisProgram(), "--family", arguments_.file, "--at=" + text(next[i]), "--ray", std::to_string(ray)});
        }
      }
      return commands;
    });
    reload();  // another process may have added members
    for (std::size_t i = 0; i < next.size(); ++i) addMember(next[i], stores[i]);
    store();
    const ExpectedError error = data_.leaveOneOutError();
    std::printf("prepare: %zu members, %zu left out: each from the others: median %.2g %%, nine of ten below %.2g %%\n",
                data_.members().size(), data_.failed().size(), 100 * error.median, 100 * error.common);
    std::fflush(stdout);
  }

  void store() {
    if (axis_forces_.size() > 0) data_.setAxisForces(axis_forces_);
    data_.update();
    data_.setProvenance(provenance());
    data_.save(path_);
  }

  void addMember(const Eigen::VectorXd& coordinates, const PathStore& store) {
    const Eigen::MatrixXd known = data_.knownPoints();
    for (Eigen::Index i = 0; i < known.cols(); ++i) {
      if (known.col(i) == coordinates) return;
    }
    try {
      Eigen::MatrixXf displacements;
      const FamilyMember member = fitMember(family_, coordinates, store.loadAll(), displacements);
      data_.add(member, displacements);
      if (member.reached.share < 1) {
        std::printf("prepare: the member at %s has a solution to %.0f %% of the planned depth\n",
                    text(coordinates).c_str(), 100 * member.reached.share);
      }
    } catch (const std::exception& error) {
      data_.addFailed(coordinates);
      std::printf("prepare: the member at %s is left out: %s\n", text(coordinates).c_str(), error.what());
    }
  }

  std::string provenance() const {
    char date[32];
    const std::time_t now = std::time(nullptr);
    std::strftime(date, sizeof(date), "%Y-%m-%d", std::gmtime(&now));
    std::ostringstream out;
    out << "made by: prepare --family " << std::filesystem::path(arguments_.file).filename().string() << " --members "
        << arguments_.members << "\nversion: " << MICROINJECTION_VERSION << "\ndate: " << date
        << "\nmembers: " << data_.members().size() << ", left out: " << data_.failed().size()
        << "\nforce error of each member from the "
        << "others: median " << data_.leaveOneOutError().median << ", nine of ten below "
        << data_.leaveOneOutError().common << '\n';
    return out.str();
  }

  void report() const {
    std::printf("prepare: family %s: %zu members, %zu left out: %s\n%s", family_.name().c_str(), data_.members().size(),
                data_.failed().size(), path_.c_str(), data_.provenance().c_str());
  }

  FamilyArguments arguments_;
  Family family_;
  std::string path_;
  FamilyData data_;
  Eigen::MatrixXd axis_forces_;  ///< that `data_` has not yet
};

}  // namespace

void prepareFamily(const FamilyArguments& arguments) { FamilyPreparation(arguments).run(); }

void solveAxisNode(const std::string& file, int node) { AxisStore(Family::load(file)).solve(node); }

int solveFamilyPath(const std::string& file, const std::string& coordinates, int ray) {
  const Family family = Family::load(file);
  const PathStore store = storeOf(family, parse(coordinates, family.dimension()));
  return store.solve(ray) == PathStore::Outcome::kBusy ? kBusyStatus : 0;
}

}  // namespace microinjection
