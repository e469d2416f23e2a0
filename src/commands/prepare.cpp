// Prepares the surrogate cell of a scene from converged solutions; see --help.

#include <sys/prctl.h>

#include <boost/program_options.hpp>
#include <chrono>
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
#include "cell/model/scene.h"
#include "cell/model/similarity.h"
#include "cell/surrogate/model_choice.h"
#include "cell/surrogate/surrogate_data.h"
#include "cell/surrogate/training_ray.h"

namespace microinjection {
namespace {

namespace po = boost::program_options;

constexpr int kDone = 0, kBadUsage = 2, kFailed = 3;

constexpr char kHelp[] =
    R"(prepare: the off-line stage. Solves a scene's cell at many contact points and displacements, and stores the data
with which a live session evaluates a converged force in microseconds.

Usage: prepare --scene FILE [--jobs N] [...]

Takes minutes, shows its progress, and may be interrupted: the next call continues from the finished paths. The data are
in $XDG_CACHE_HOME (else ~/.cache) under cell_microinjection/prepared, in a folder named after the cell, the tip and
the program's version. Cells that differ in scale, or whose moduli and tensions differ by one factor, have the same data.
Another tip, another ratio of lengths or another ratio of moduli needs its own; another needle offset does not.

Data that are damaged, or of another version, are reported and replaced.

Where the cell has no solution in a part of the range, the range shrinks, which is reported.

Exit status: 0 prepared (or was already); 2 bad usage, a scene that cannot be prepared (friction, adhesion, a viscosity
that does not relax, a sharp disc on a nonlinear cell, tensegrity: the message names it), or data or output that cannot
be written (the message names the path and the reason; the folder is checked first); 3 a path ends before a fifth of its
length: nothing is stored.

Options)";

struct Arguments {
  std::string scene;
  int jobs = 1;
  int ray = -1;
  bool again = false;
  bool show_help = false;
  std::string options;
};

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  const int processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  po::options_description visible, all;
  visible.add_options()("help", "this text")("scene", po::value(&arguments.scene), "scene file (YAML, SI units)")(
      "jobs", po::value(&arguments.jobs)->default_value(processors), "paths solved at a time, each on one core")(
      "again", po::bool_switch(&arguments.again), "replaces data that were prepared before");
  po::options_description hidden;
  hidden.add_options()("ray", po::value(&arguments.ray), "solves only this path, as a worker process");
  all.add(visible).add(hidden);
  po::variables_map values;
  po::store(po::command_line_parser(argc, argv).options(all).positional({}).run(), values);
  po::notify(values);
  std::ostringstream options;
  options << visible;
  arguments.options = options.str();
  arguments.show_help = values.count("help") != 0;
  if (arguments.show_help) return arguments;
  if (arguments.scene.empty()) throw ConfigError("--scene is missing");
  if (arguments.jobs < 1) throw ConfigError("--jobs = " + std::to_string(arguments.jobs) + ": must be 1 or more");
  return arguments;
}

class Preparing {
 public:
  explicit Preparing(const Arguments& arguments)
      : arguments_(arguments),
        scene_(loadScene(arguments.scene)),
        solved_(withoutDimension(scene_)),
        plan_(Preparation::plan(solved_, PreparationRange::standard(solved_))),
        folder_(preparedFolder(solved_, plan_)) {
    Preparation::check(scene_);
    if (folder_.empty()) throw ConfigError("neither XDG_CACHE_HOME nor HOME is set: no folder for the data");
  }

  int work() {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // the workers end when the preparation is killed
    const TrainingRay& ray = plan_.rays.at(arguments_.ray);
    try {
      writeCacheFile(file(arguments_.ray), description(arguments_.ray), encode(solveRay(solved_, ray)));
    } catch (const std::exception&) {
      std::fputc('\n', stderr);  // ends the progress line of the preparation
      throw;
    }
    return kDone;
  }

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
    solveMissing();
    const std::vector<TrainingResult> results = loadAll();
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

  /// Reports a cache file that exists and cannot be used.
  static void reportDamage(CacheState state, const std::string& reason) {
    if (state == CacheState::kRead || state == CacheState::kMissing) return;
    std::fprintf(stderr, "prepare: %s; it is replaced\n", reason.c_str());
  }

  /// Checks before minutes of work that the results can be written.
  void requireWritable(const std::string& prepared) const {
    requireWritableFolder(folder_);
    std::vector<std::string> paths = {prepared};
    for (std::size_t i = 0; i < plan_.rays.size(); ++i) paths.push_back(file(i));
    std::error_code error;
    for (const std::string& path : paths) {
      if (std::filesystem::is_directory(path, error)) throw WriteError(path, "it is a directory; remove it");
    }
  }

  CacheRead<TrainingResult> load(std::size_t ray) const {
    return loadTraining(file(ray), description(ray), plan_.rays[ray], surface_size_);
  }

  /// Results of all paths.
  std::vector<TrainingResult> loadAll() const {
    std::vector<TrainingResult> results;
    for (std::size_t i = 0; i < plan_.rays.size(); ++i) {
      const CacheRead<TrainingResult> read = load(i);
      if (!read) throw std::runtime_error(read.reason);
      results.push_back(*read.content);
      if (!results.back().reason.empty()) reportEarlyEnd(plan_.rays[i], results.back());
    }
    return results;
  }

  std::string description(std::size_t ray) const { return plan_.description(solved_, plan_.rays[ray]); }
  std::string file(std::size_t ray) const { return folder_ + "/path_" + contentHash(description(ray)); }

  std::vector<std::size_t> missingRays() const {
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < plan_.rays.size(); ++i) {
      if (!arguments_.again) {
        const CacheRead<TrainingResult> read = load(i);
        if (read) continue;
        reportDamage(read.state, read.reason);
      }
      missing.push_back(i);
    }
    return missing;
  }

  void solveMissing() {
    surface_size_ = trainingSurface(solved_, 0).nodes.size();
    const std::vector<std::size_t> missing = missingRays();
    std::vector<std::vector<std::string>> commands;
    for (const std::size_t i : missing) {
      commands.push_back({thisProgram(), "--scene", arguments_.scene, "--ray", std::to_string(i)});
    }
    const auto start = std::chrono::steady_clock::now();
    std::size_t done = 0;
    show(done, missing.size(), 0);
    runWorkers(commands, arguments_.jobs, [&](std::size_t index, int status) {
      const std::string failed = "path " + std::to_string(missing[index]) + " failed, see above";
      if (status == kBadUsage) throw ConfigError(failed);
      if (status != 0) throw std::runtime_error(failed);
      const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      show(++done, missing.size(), spent);
    });
    if (!missing.empty()) std::fprintf(stderr, "\n");
  }

  static void show(std::size_t done, std::size_t all, double spent) {
    if (all == 0) return;
    constexpr std::size_t kWidth = 30;
    const std::string bar(kWidth * done / all, '#');
    std::fprintf(stderr, "\rprepare: [%-*s] %zu of %zu paths, %.0f s", static_cast<int>(kWidth), bar.c_str(), done, all,
                 spent);
    std::fflush(stderr);
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
    const double reached = result.samples.empty() ? 0 : result.samples.back().displacement.norm();
    std::fprintf(stderr, "prepare: a path at %.0f degrees ends at %.3g of %.3g um: %s\n", ray.angle * 57.2958,
                 1e6 * scene_.radius() * reached, 1e6 * scene_.radius() * ray.target.norm(), result.reason.c_str());
  }

  Arguments arguments_;
  Scene scene_;
  Scene solved_;      ///< the same without dimension
  Preparation plan_;  ///< of it
  std::string folder_;
  Eigen::Index surface_size_ = 0;  ///< numbers of a path's surface; set before paths are solved
};

int run(int argc, char** argv) {
  try {
    const Arguments arguments = parse(argc, argv);
    if (arguments.show_help) {
      std::cout << kHelp << arguments.options;
      flushStandardOutput();
      return kDone;
    }
    Preparing preparing(arguments);
    const int status = arguments.ray >= 0 ? preparing.work() : preparing.run();
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
