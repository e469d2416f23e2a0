// Solves many scenes, each a task of its own; see --help.

#include <boost/program_options.hpp>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/atomic_file.h"
#include "base/command_line.h"
#include "base/errors.h"
#include "base/standard_output.h"
#include "base/worker_processes.h"
#include "commands/run_tasks.h"
#include "commands/sweep_file.h"
#include "commands/sweep_store.h"

namespace microinjection {
namespace {

/// Of the command `sweep`; its --help explains them.
struct SweepArguments {
  std::string file, out;
  bool list = false, gather = false;
  long task = -1;  ///< the first task to do; -1: all that are missing
  int count = 1;
  int jobs = 1;
  bool worker = false;
};

constexpr char kSweepHelp[] =
    R"(sweep: the force of many scenes, each a task of its own, on this machine or on a cluster.

Usage: sweep --file FILE --list                        prints the tasks and the values of their keys
       sweep --file FILE --out DIR [--jobs N]          solves all tasks that are missing, then gathers
       sweep --file FILE --out DIR --task N [--count K]   solves the tasks N to N + K - 1
       sweep --file FILE --out DIR --gather            writes DIR/sweep.csv from the results

FILE names a scene, the keys that vary over a grid or at random, and the indentation (as of `indent`);
see config/sweeps and doc/reference/sweep_file.md. Each task has one file in DIR, with a checksum; it is whole or not there.
A call that was killed continues where it ended. Several calls may share DIR, on several machines, too. The table is the
same bytes whoever solved which task.

Columns: task, a column for each key, depth_m,force_x_N,force_y_N,force_z_N,converged,error_estimate,reason

Exit status: 0 done; 2 bad usage, a file that is not valid, tasks that are missing (--gather), or output that cannot be
written; 3 a task ended otherwise.

Options)";

/// Nothing after printing the help. Throws ConfigError that names the option.
std::optional<SweepArguments> parseSweepArguments(int argc, char** argv) {
  namespace po = boost::program_options;
  SweepArguments arguments;
  const int processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  po::options_description visible("", 118), hidden;
  visible.add_options()("help", "this text")("file", po::value(&arguments.file), "sweep file (YAML)")(
      "out", po::value(&arguments.out), "folder of the results")("list", po::bool_switch(&arguments.list),
                                                                 "prints the tasks as CSV, solves nothing")(
      "task", po::value(&arguments.task), "first task to solve, from 0")(
      "count", po::value(&arguments.count)->default_value(1), "tasks to solve from there; the sweep's end ends it")(
      "gather", po::bool_switch(&arguments.gather), "only writes the table")(
      "jobs", po::value(&arguments.jobs)->default_value(processors), "tasks at a time, each on one core");
  hidden.add_options()("worker", po::bool_switch(&arguments.worker), "ends with the process that started it");
  po::variables_map values;
  if (!readCommandLine(wordsOf(argc, argv), visible, kSweepHelp, values, "", 1, hidden)) return std::nullopt;
  const auto require = [](bool good, const std::string& message) {
    if (!good) throw ConfigError(message);
  };
  const bool task = values.count("task") != 0;
  require(!arguments.file.empty(), "--file is missing: a sweep file, see --help");
  require(arguments.list != !arguments.out.empty(), "one of --list and --out must be given");
  require(!(task && arguments.gather), "--task and --gather: only one may be given");
  require(!task || arguments.task >= 0, "--task = " + std::to_string(arguments.task) + ": must be 0 or more");
  require(arguments.count >= 1, "--count = " + std::to_string(arguments.count) + ": must be 1 or more");
  require(arguments.jobs >= 1, "--jobs = " + std::to_string(arguments.jobs) + ": must be 1 or more");
  return arguments;
}

void list(const SweepFile& sweep) {
  std::cout << sweep.columns() << '\n';
  for (std::size_t task = 0; task < sweep.design().size(); ++task) {
    sweep.task(task);  // which throws when it is not valid
    std::cout << sweep.columns(task) << '\n';
  }
}

void solveTasks(const SweepArguments& arguments, const SweepFile& sweep, const SweepStore& store) {
  const auto first = static_cast<std::size_t>(arguments.task);
  const std::size_t size = sweep.design().size();
  if (first >= size) {
    throw ConfigError("--task = " + std::to_string(first) + ": must be below " + std::to_string(size) +
                      ", the number of tasks");
  }
  prepareWorker(arguments.worker);
  const std::size_t end = std::min(size, first + static_cast<std::size_t>(arguments.count));
  for (std::size_t task = first; task < end; ++task) store.solve(task);
}

/// Blocks of tasks that follow each other: starting a process takes longer than a short task.
std::vector<Work> blocks(const SweepArguments& arguments, const std::vector<std::size_t>& missing) {
  const std::size_t largest = std::clamp<std::size_t>(missing.size() / (16 * arguments.jobs), 1, 64);
  std::vector<Work> result;
  for (std::size_t i = 0; i < missing.size();) {
    std::size_t count = 1;
    while (count < largest && i + count < missing.size() && missing[i + count] == missing[i] + count) ++count;
    result.push_back({{thisProgram(), "--file", arguments.file, "--out", arguments.out, "--task",
                       std::to_string(missing[i]), "--count", std::to_string(count), "--worker"},
                      count});
    i += count;
  }
  return result;
}

int sweep(const SweepArguments& arguments) {
  const SweepFile sweep(arguments.file);
  if (arguments.list) {
    list(sweep);
    return kDone;
  }
  requireWritableFolder(arguments.out);
  const SweepStore store(sweep, arguments.out);
  if (arguments.task >= 0) {
    solveTasks(arguments, sweep, store);
    return kDone;
  }
  if (!arguments.gather) {
    runTasks("sweep", "tasks", arguments.jobs,
             [&] { return blocks(arguments, store.missing(0, sweep.design().size())); });
  }
  const std::string table = arguments.out + "/sweep.csv";
  writeFileAtomically(table, store.table());
  std::printf("sweep: %zu tasks: %s\n", sweep.design().size(), table.c_str());
  return kDone;
}

int run(int argc, char** argv) {
  const std::optional<SweepArguments> arguments = parseSweepArguments(argc, argv);
  if (!arguments) return kDone;  // the help
  const int status = sweep(*arguments);
  flushStandardOutput();
  return status;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  using namespace microinjection;
  return runProgram(
      "sweep", [&] { return run(argc, argv); }, kFailed);
}
