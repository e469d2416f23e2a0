// Prepares the surrogate cell of a scene from converged solutions; see --help.

#include <malloc.h>
#include <sys/prctl.h>

#include <boost/program_options.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "base/atomic_file.h"
#include "base/cache_file.h"
#include "base/errors.h"
#include "base/standard_output.h"
#include "base/worker_processes.h"
#include "cell/choice/model_choice.h"
#include "cell/family/family_cell.h"
#include "cell/mechanics/symmetric_solver.h"
#include "cell/model/scene.h"
#include "cell/model/similarity.h"
#include "cell/surrogate/surrogate_data.h"
#include "cell/surrogate/training_ray.h"
#include "commands/path_store.h"
#include "commands/prepare_family.h"
#include "commands/solve_paths.h"

namespace microinjection {
namespace {

namespace po = boost::program_options;

constexpr int kDone = 0, kBadUsage = 2, kFailed = 3;

constexpr char kHelp[] =
    R"(prepare: the off-line stage. Solves a scene's cell at many contact points and displacements, and stores the data
with which a live session evaluates a converged force in microseconds.

Usage: prepare --scene FILE [--jobs N] [...]
       prepare --family FILE [--members N | --check N] [--jobs N]

Takes minutes, shows its progress, and may be interrupted: the next call continues from the finished paths. The data are
in $XDG_CACHE_HOME (else ~/.cache) under cell_microinjection/prepared, in a folder named after the cell, the tip and
the program's version. Cells that differ in scale, or whose moduli and tensions differ by one factor, have the same data.
Another tip, another ratio of lengths or another ratio of moduli needs its own; another needle offset does not.

With --family it solves members of a family of cells, each in minutes, and stores the family's data beside its file (NAME.data
beside NAME.yaml). Every cell inside of the family is then served at once, without a preparation. The members are where
the prediction from the solved ones is least certain. Several processes with one cache share the work.

Data that are damaged, or of another version, are reported and replaced.

Where the cell has no solution in a part of the range, the range shrinks, which is reported.

Exit status: 0 prepared (or was already); 2 bad usage, a scene that cannot be prepared (friction, adhesion, a viscosity
that does not relax, a sharp disc on a nonlinear cell, tensegrity: the message names it), or data or output that cannot
be written (the message names the path and the reason; the folder is checked first); 3 a path ends before a fifth of its
length: nothing is stored.

Options)";

struct Arguments {
  std::string scene;
  std::string families;
  FamilyArguments family;
  int jobs = 1;
  int ray = -1;
  std::string at;  ///< coordinates of a family's member
  int member = -1;
  int axis = -1;
  bool again = false;
  bool show_help = false;
  std::string options;
};

void requireAtLeast(const std::string& option, int value, int least) {
  if (value >= least) return;
  throw ConfigError("--" + option + " = " + std::to_string(value) + ": must be " + std::to_string(least) + " or more");
}

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  const int processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  po::options_description visible, all;
  FamilyArguments& family = arguments.family;
  visible.add_options()("help", "this text")("scene", po::value(&arguments.scene), "scene file (YAML, SI units)")(
      "families", po::value(&arguments.families),
      "prepares nothing when a family of this folder serves the scene as exactly as its requirements ask for")(
      "family", po::value(&family.file), "family file (YAML), instead of a scene")(
      "members", po::value(&family.members)->default_value(family.members), "members that the family shall have")(
      "check", po::value(&family.check)->default_value(0),
      "draws this many members of the family that were never solved, solves them and prints the family's errors")(
      "record", po::bool_switch(&family.record),
      "with --check: the family's data keep the errors, and cell_simulator then expects them")(
      "refit", po::bool_switch(&family.refit), "first fits the family's members anew to the forces that it keeps")(
      "seed", po::value(&family.seed)->default_value(family.seed), "of the draw")("csv", po::value(&family.csv),
                                                                                  "file for the table of the check")(
      "reference", po::value(&family.reference),
      "file of the check's solutions: those that it has are not solved again, the others are added")(
      "jobs", po::value(&arguments.jobs)->default_value(processors), "paths solved at a time, each on one core")(
      "again", po::bool_switch(&arguments.again), "replaces data that were prepared before");
  po::options_description hidden;
  hidden.add_options()("ray", po::value(&arguments.ray), "solves only this path, as a worker process")(
      "at", po::value(&arguments.at), "of the family's member at these coordinates")(
      "member", po::value(&arguments.member), "of this member of the check")(
      "axis", po::value(&arguments.axis), "solves only this node of the family's grid on the axis");
  all.add(visible).add(hidden);
  po::variables_map values;
  po::store(po::command_line_parser(argc, argv).options(all).positional({}).run(), values);
  po::notify(values);
  std::ostringstream options;
  options << visible;
  arguments.options = options.str();
  arguments.show_help = values.count("help") != 0;
  if (arguments.show_help) return arguments;
  if (arguments.scene.empty() == family.file.empty()) throw ConfigError("one of --scene and --family must be given");
  requireAtLeast("jobs", arguments.jobs, 1);
  requireAtLeast("members", family.members, 1);
  requireAtLeast("check", family.check, 0);
  family.jobs = arguments.jobs;
  return arguments;
}

class Preparing {
 public:
  explicit Preparing(const Arguments& arguments)
      : arguments_(arguments),
        scene_(loadScene(arguments.scene)),
        solved_(withoutDimension(scene_)),
        plan_(Preparation::plan(solved_, PreparationRange::standard(solved_))),
        paths_(solved_, plan_) {
    Preparation::check(scene_);
  }

  int work() { return paths_.solve(arguments_.ray) == PathStore::Outcome::kBusy ? kBusyStatus : kDone; }

  int run() {
    const std::string path = preparedFile(solved_, plan_);
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
    solvePaths("prepare", arguments_.jobs, [&] {
      std::vector<std::vector<std::string>> commands;
      for (const std::size_t i : paths_.missing()) {
        commands.push_back({thisProgram(), "--scene", arguments_.scene, "--ray", std::to_string(i)});
      }
      return commands;
    });
  }

  /// Reports what is smaller than planned.
  void reportRange(const PreparationRange& reached) const {
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

  Arguments arguments_;
  Scene scene_;
  Scene solved_;      ///< the same without dimension
  Preparation plan_;  ///< of it
  PathStore paths_;
};

/// Solves one path, as a process that ends when the preparation is killed.
int work(const Arguments& arguments) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The solver allocates and releases large blocks in every step: the system need not have them back.
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  SymmetricSolver::useOneThread();  // the paths are solved side by side; more threads only wait for each other
  try {
    if (arguments.family.file.empty()) return Preparing(arguments).work();
    if (arguments.axis >= 0) {
      solveAxisNode(arguments.family.file, arguments.axis);
      return kDone;
    }
    if (arguments.member >= 0) return solveCheckPath(arguments.family, arguments.member, arguments.ray);
    return solveFamilyPath(arguments.family.file, arguments.at, arguments.ray);
  } catch (const std::exception&) {
    std::fputc('\n', stderr);  // ends the progress line of the preparation
    throw;
  }
}

/// Whether a family serves the scene to its requirements.
bool isServed(const Arguments& arguments) {
  if (arguments.families.empty() || arguments.again) return false;
  const Scene scene = loadScene(arguments.scene);
  std::string reason;
  const auto member = findFamilyCell(arguments.families, scene, reason);
  if (!member || member->data->common_error > scene.requirements.force_error) {
    std::printf("prepare: no family serves the scene as exactly as it asks for: %s\n",
                member ? member->description.c_str() : reason.c_str());
    return false;
  }
  std::printf("prepare: served without preparation: %s\n", member->description.c_str());
  return true;
}

int prepare(const Arguments& arguments) {
  if (arguments.family.file.empty()) return isServed(arguments) ? kDone : Preparing(arguments).run();
  arguments.family.check > 0 ? checkFamily(arguments.family) : prepareFamily(arguments.family);
  return kDone;
}

int run(int argc, char** argv) {
  try {
    const Arguments arguments = parse(argc, argv);
    if (arguments.show_help) {
      std::cout << kHelp << arguments.options;
      flushStandardOutput();
      return kDone;
    }
    const int status = arguments.ray >= 0 || arguments.axis >= 0 ? work(arguments) : prepare(arguments);
    flushStandardOutput();
    return status;
  } catch (const po::error& error) {
    std::cerr << "prepare: " << error.what() << "; see --help\n";
    return kBadUsage;
  } catch (const UserError& error) {
    std::cerr << "prepare: " << error.what() << '\n';
    return kBadUsage;
  } catch (const std::exception& error) {
    std::cerr << "prepare: " << error.what() << '\n';
    return kFailed;
  }
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) { return microinjection::run(argc, argv); }
