// Prepares the surrogate cell of a scene from converged solutions; see --help.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/command_line.h"
#include "base/errors.h"
#include "base/standard_output.h"
#include "base/worker_processes.h"
#include "cell/choice/make_cell_model.h"
#include "cell/choice/model_choice.h"
#include "cell/family/pierced_family.h"
#include "cell/family/section_family.h"
#include "cell/family/withdrawal_family.h"
#include "cell/model/scene.h"
#include "cell/model/similarity.h"
#include "cell/model/solved_branch.h"
#include "cell/surrogate/surrogate_data.h"
#include "cell/surrogate/training_ray.h"
#include "commands/path_store.h"
#include "commands/prepare_arguments.h"
#include "commands/prepare_family.h"
#include "commands/prepare_section_family.h"
#include "commands/run_tasks.h"

namespace microinjection {
namespace {

class Preparing {
 public:
  explicit Preparing(const PrepareArguments& arguments)
      : arguments_(arguments),
        scene_(loadScene(arguments.scene).glued()),
        solved_(withoutDimension(scene_)),
        plan_(SurrogatePlan::plan(solved_, SurrogateRange::standard(solved_))),
        paths_(solved_, plan_) {
    SurrogatePlan::check(scene_);
  }

  int work() { return paths_.solve(arguments_.ray) == PathStore::Outcome::kBusy ? kBusyStatus : kDone; }

  int run() {
    const std::string path = surrogateFile(solved_, plan_);
    if (const auto before = preparedBefore(path)) {
      std::printf("prepare: was prepared before: %s\n", path.c_str());
      reportRange(before->range);
      const auto figures = loadFigures(scene_, "live");
      if (figures) return kDone;
      reportDamage(figures.state, figures.reason);
      requireWritable(path);
      measureLiveModel();  // figures of another live mesh, or of an interrupted run
      return kDone;
    }
    requireWritable(path);
    removePathsToReplace();
    solveMissing();
    const std::vector<TrainingResult> results = paths_.loadAll();
    for (std::size_t i = 0; i < results.size(); ++i) reportEarlyEnd(plan_.rays[i], results[i]);
    std::fprintf(stderr, "prepare: fitting\n");
    const SurrogateData cell = SurrogateData::fit(solved_, plan_, results);
    cell.save(solved_, plan_.range, path);
    reportRange(cell.range);
    std::printf(
        "prepare: done: %s\nprepare: the fit's force error at the equilibria: median %.2g %%, nine of ten below %.2g "
        "%%, "
        "largest %.2g %%\n",
        path.c_str(), 100 * cell.median_error, 100 * cell.common_error, 100 * cell.largest_error);
    std::printf("prepare: of an energy alone: median %.2g %%, nine of ten below %.2g %%\n",
                100 * cell.energy_median_error, 100 * cell.energy_common_error);
    measureLiveModel();
    return kDone;
  }

 private:
  /// Stores the live model's error and time, which `model:=auto` compares.
  void measureLiveModel() const {
    try {
      const ModelFigures live = measureLiveCell(scene_);
      saveFigures(scene_, live);
      std::printf("prepare: the live model: largest force error %.3g %%, %.3g ms a solution\n", 100 * live.force_error,
                  1e3 * live.time);
    } catch (const ConfigError& error) {
      std::printf("prepare: no live model: %s\n", error.what());
    }
  }

  std::optional<SurrogateData> preparedBefore(const std::string& path) const {
    if (arguments_.again) return std::nullopt;
    auto prepared = SurrogateData::load(solved_, plan_.range, path);
    reportDamage(prepared.state, prepared.reason);
    return std::move(prepared.content);
  }

  /// Checks before minutes of work that the results can be written.
  void requireWritable(const std::string& prepared) const {
    requireWritableFolder(paths_.folder());
    std::vector<std::string> paths = {prepared};
    for (std::size_t i = 0; i < plan_.rays.size(); ++i) paths.push_back(paths_.file(i));
    std::error_code error;
    for (const std::string& path : paths) {
      if (std::filesystem::is_directory(path, error)) throw WriteError(path, "it is a directory; remove it");
    }
  }

  void removePathsToReplace() const {
    std::error_code error;
    for (std::size_t i = 0; arguments_.again && i < plan_.rays.size(); ++i) {
      std::filesystem::remove(paths_.file(i), error);
    }
  }

  void solveMissing() const {
    runTasks("prepare", "paths", arguments_.jobs, [&] {
      std::vector<Work> commands;
      for (const std::size_t i : paths_.missing()) {
        commands.push_back({{thisProgram(), "--scene", arguments_.scene, "--ray", std::to_string(i)}});
      }
      return commands;
    });
  }

  /// Reports what is smaller than planned.
  void reportRange(const SurrogateRange& reached) const {
    const double unit = 1e6 * scene_.radius();  // um
    if (reached.depth < 0.999 * plan_.range.depth) {
      std::fprintf(stderr, "prepare: the range is smaller than planned: %.3g um deep, %.3g um sideways\n",
                   unit * reached.depth, unit * reached.lateral);
    }
    if (reached.axis_depth < 0.999 * plan_.range.axis_depth) {
      std::fprintf(stderr, "prepare: on the axis the cell has a solution to %.3g um only\n", unit * reached.axis_depth);
    }
  }

  void reportEarlyEnd(const TrainingRay& ray, const TrainingResult& result) const {
    if (result.reason.empty()) return;
    const double reached = result.samples.empty() ? 0 : result.samples.back().displacement.norm();
    std::fprintf(stderr, "prepare: a path at %.0f degrees ends at %.3g of %.3g um: %s\n", ray.angle * 57.2958,
                 1e6 * scene_.radius() * reached, 1e6 * scene_.radius() * ray.target.norm(), result.reason.c_str());
  }

  PrepareArguments arguments_;
  Scene scene_;
  Scene solved_;        ///< the same without dimension
  SurrogatePlan plan_;  ///< of it
  PathStore paths_;
};

/// Solves one path, as a process that ends when the preparation is killed.
int work(const PrepareArguments& arguments) {
  prepareWorker(arguments.task < 0);
  try {
    if (arguments.task >= 0) return solveFamilyTasks(arguments.family, arguments.task, arguments.count);
    if (arguments.family.file.empty()) return Preparing(arguments).work();
    if (arguments.axis >= 0) {
      solveAxisNode(arguments.family.file, arguments.axis);
      return kDone;
    }
    if (arguments.member >= 0) return solveCheckPath(arguments.family, arguments.member, arguments.ray);
    if (arguments.ray >= 0) return solveFamilyPath(arguments.family.file, arguments.at, arguments.ray);
    solveSectionMember(arguments.family.file, arguments.at);
    return kDone;
  } catch (const std::exception&) {
    std::fputc('\n', stderr);  // ends the progress line of the preparation
    throw;
  }
}

/// What a scene's puncture needs, where it follows from a toughness.
void preparePuncture(const std::string& path, const std::string& families) {
  const Scene scene = loadScene(path).glued();
  std::string reason;
  if (!piercedByMechanics(scene) || findFamilyBranch(families, scene, reason)) return;
  const PiercedBranch branch = storedPiercedBranch(scene, [](int solved, int count) {
    std::fprintf(stderr, "prepare: the cell with holes under the needle: path %d of %d\n", solved + 1, count);
  });
  std::printf("prepare: %s\n", describePuncture(branch, scene).c_str());
}

/// Whether a family serves the scene to its requirements.
bool isServed(const PrepareArguments& arguments) {
  if (arguments.families.empty() || arguments.again) return false;
  const Scene scene = loadScene(arguments.scene).glued();
  std::string reason;
  const bool adheres = scene.needle.contact.adhesion_energy > 0;
  const std::optional<WithdrawalLoss> loss = findWithdrawal(arguments.families, scene, reason);
  SurrogateSource source;
  if (!adheres || loss) source = findFamilySource(withoutAdhesion(scene), arguments.families, reason);
  const double error = source.data ? std::max(source.data->common_error, loss ? loss->error() : 0) : 1;
  const bool exact = error <= scene.requirements.force_error;
  std::printf(exact ? "prepare: served without preparation: %s\n"
                    : "prepare: no family serves the scene as exactly as it asks for: %s\n",
              source.data ? source.text.c_str() : reason.c_str());
  return exact;
}

int prepare(const PrepareArguments& arguments) {
  if (arguments.family.file.empty()) {
    preparePuncture(arguments.scene, arguments.families);
    return isServed(arguments) ? kDone : Preparing(arguments).run();
  }
  if (SectionFamily::kindOf(arguments.family.file)) return prepareSectionFamily(arguments.family), kDone;
  arguments.family.check > 0 ? checkFamily(arguments.family) : prepareFamily(arguments.family);
  return kDone;
}

int run(int argc, char** argv) {
  const std::optional<PrepareArguments> arguments = parsePrepareArguments(argc, argv);
  if (!arguments) return kDone;  // the help
  const bool worker = arguments->ray >= 0 || arguments->axis >= 0 || arguments->task >= 0 || !arguments->at.empty();
  const int status = worker ? work(*arguments) : prepare(*arguments);
  flushStandardOutput();
  return status;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  using namespace microinjection;
  return runProgram(
      "prepare", [&] { return run(argc, argv); }, kFailed);
}
