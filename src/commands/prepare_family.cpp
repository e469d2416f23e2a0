#include "commands/prepare_family.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/errors.h"
#include "base/worker_processes.h"
#include "cell/family/axis_force.h"
#include "cell/family/family_data.h"
#include "cell/family/family_file.h"
#include "cell/family/next_members.h"
#include "cell/mechanics/symmetric_solver.h"
#include "commands/axis_store.h"
#include "commands/family_plan.h"
#include "commands/path_store.h"
#include "commands/run_tasks.h"

namespace microinjection {
namespace {

constexpr int kRound = 4;  ///< members that are solved before the next are chosen

std::string text(const Eigen::VectorXd& coordinates) { return coordinatesText(coordinates, ','); }

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
      const int refitted = data_.refit();
      std::printf("prepare: %d members fitted anew\n", refitted);
      store(refitted > 0);
    }
    for (FamilyPlan plan = next(); !plan.tasks().empty(); plan = next()) {
      solve(plan);
      gather(plan);
    }
    report();
  }

  void list(const std::string& file) const {
    const FamilyPlan plan = next();
    plan.save(file);
    std::printf("prepare: %d of %d members, %zu tasks in the next round: %s\n", count(), arguments_.members,
                plan.tasks().size(), file.c_str());
  }

  int solveTasks(const std::string& file, std::size_t first, std::size_t count) const {
    const FamilyPlan plan = read(file);
    if (first >= plan.tasks().size()) {
      throw ConfigError("--task = " + std::to_string(first) + ": must be below " + std::to_string(plan.tasks().size()) +
                        ", the number of tasks");
    }
    int status = 0;
    for (std::size_t i = first; i < std::min(plan.tasks().size(), first + count); ++i)
      status = std::max(status, solveTask(plan.tasks()[i]));
    return status;
  }

  void gather(const std::string& file) {
    const FamilyPlan plan = read(file);
    const auto isKnown = [this](const Eigen::VectorXd& member) { return has(member); };
    if (!plan.members().empty() && std::all_of(plan.members().begin(), plan.members().end(), isKnown)) {
      std::printf("prepare: the members of %s were added before\n", file.c_str());
      return;
    }
    const std::size_t missing = commandsFor(plan).size();
    if (missing > 0) {
      throw ConfigError(file + ": " + std::to_string(missing) + " of " + std::to_string(plan.tasks().size()) +
                        " tasks are missing");
    }
    arguments_.members = plan.wanted();  // the data name it, and are the same bytes as without a plan
    gather(plan);
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

  /// The next round's tasks; none when the family is complete.
  FamilyPlan next() const {
    FamilyPlan plan(family_, arguments_.members);
    if (needsAxisForces()) plan.addAxisNodes(static_cast<int>(axisForceGrid(family_).size()));
    const int round = std::min(kRound, arguments_.members - count());
    if (round <= 0) return plan;
    for (const Eigen::VectorXd& member : nextMembers(data_.knownPoints(), lengths(), round))
      plan.addMember(member, storeOf(family_, member).plan().rays.size());
    return plan;
  }

  int solveTask(const FamilyPlan::Task& task) const {
    if (task.coordinates.size() == 0) {
      AxisStore(family_).solve(task.piece);
      return 0;
    }
    const PathStore store = storeOf(family_, task.coordinates);
    return store.solve(static_cast<std::size_t>(task.piece)) == PathStore::Outcome::kBusy ? kBusyStatus : 0;
  }

  FamilyPlan read(const std::string& file) const {
    FamilyPlan plan(family_);
    plan.load(file);
    if (arguments_.members_given && arguments_.members != plan.wanted()) {
      throw ConfigError("--members = " + std::to_string(arguments_.members) + ": must be " +
                        std::to_string(plan.wanted()) + ", as of " + file + ", or left out");
    }
    return plan;
  }

  /// False also when some members are known to have no solution on the axis.
  bool needsAxisForces() const {
    const AxisStore store(family_);
    return !data_.hasAxisCurves() && (!store.missing().empty() || store.loadAll().size() > 0);
  }

  std::vector<Work> commandsFor(const FamilyPlan& plan) const {
    std::vector<Work> commands;
    const auto add = [&](const std::vector<std::string>& piece) {
      Work work{{thisProgram(), "--family", arguments_.file}};
      work.command.insert(work.command.end(), piece.begin(), piece.end());
      commands.push_back(work);
    };
    const bool axis = !plan.tasks().empty() && plan.tasks().front().coordinates.size() == 0;
    if (axis) {
      for (const int node : AxisStore(family_).missing()) add({"--axis", std::to_string(node)});
    }
    for (const Eigen::VectorXd& member : plan.members()) {
      for (const std::size_t ray : storeOf(family_, member).missing())
        add({"--at=" + text(member), "--ray", std::to_string(ray)});
    }
    return commands;
  }

  void solve(const FamilyPlan& plan) const {
    const std::string title = "prepare: members " + std::to_string(count() + 1) + " to " +
                              std::to_string(count() + plan.members().size()) + " of " +
                              std::to_string(arguments_.members);
    runTasks(plan.members().empty() ? "prepare: forces on the axis" : title, "paths", arguments_.jobs,
             [&] { return commandsFor(plan); });
  }

  void gather(const FamilyPlan& plan) {
    SymmetricSolver::useOneThread();  // the fit is the same bytes on any number of cores
    reload();                         // another process may have added members
    bool added = false;
    for (const Eigen::VectorXd& member : plan.members()) added |= addMember(member, storeOf(family_, member));
    store(added);
    const ExpectedError error = data_.leaveOneOutError();
    std::printf("prepare: %zu members, %zu left out: each from the others: median %.2g %%, nine of ten below %.2g %%\n",
                data_.members().size(), data_.failed().size(), 100 * error.median, 100 * error.common);
    std::fflush(stdout);
  }

  /// Whether the data did not have them before, and now have them.
  bool addAxisForces() {
    const AxisStore axis(family_);
    if (data_.hasAxisCurves() || !axis.missing().empty()) return false;
    const Eigen::MatrixXd forces = axis.loadAll();
    if (forces.size() > 0) {
      data_.setAxisForces(forces);
    } else if (!axis_reported_) {
      axis_reported_ = true;
      std::printf("prepare: some members have no solution on the axis: its force is interpolated between members\n");
    }
    return forces.size() > 0;
  }

  /// Data that did not change keep their measured errors, which update() forgets.
  void store(bool changed) {
    changed |= addAxisForces();
    if (!changed) return;
    data_.update();
    data_.setProvenance(provenance());
    data_.save(path_);
  }

  /// Whether the member is in the data, or was left out.
  bool has(const Eigen::VectorXd& coordinates) const {
    const Eigen::MatrixXd known = data_.knownPoints();
    for (Eigen::Index i = 0; i < known.cols(); ++i) {
      if (known.col(i) == coordinates) return true;
    }
    return false;
  }

  /// Also adds it to those that are left out. False when it is known.
  bool addMember(const Eigen::VectorXd& coordinates, const PathStore& store) {
    if (has(coordinates)) return false;
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
    return true;
  }

  std::string provenance() const {
    std::ostringstream out;
    out << "made by: prepare --family " << std::filesystem::path(arguments_.file).filename().string() << " --members "
        << arguments_.members << "\nversion: " << MICROINJECTION_VERSION << "\nmembers: " << data_.members().size()
        << ", left out: " << data_.failed().size() << "\nforce error of each member from the "
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
  bool axis_reported_ = false;
};

}  // namespace

void prepareFamily(const FamilyArguments& arguments) {
  FamilyPreparation family(arguments);
  if (!arguments.list.empty()) return family.list(arguments.list);
  if (!arguments.plan.empty()) return family.gather(arguments.plan);
  family.run();
}

int solveFamilyTasks(const FamilyArguments& arguments, int first, int count) {
  return FamilyPreparation(arguments).solveTasks(arguments.plan, static_cast<std::size_t>(first),
                                                 static_cast<std::size_t>(count));
}

void solveAxisNode(const std::string& file, int node) { AxisStore(Family::load(file)).solve(node); }

int solveFamilyPath(const std::string& file, const std::string& coordinates, int ray) {
  const Family family = Family::load(file);
  const auto parsed = parseCoordinates(coordinates, ',');
  if (!parsed || parsed->size() != family.dimension()) {
    throw ConfigError("--at = " + coordinates + ": must be " + std::to_string(family.dimension()) + " numbers");
  }
  const PathStore store = storeOf(family, *parsed);
  return store.solve(ray) == PathStore::Outcome::kBusy ? kBusyStatus : 0;
}

}  // namespace microinjection
