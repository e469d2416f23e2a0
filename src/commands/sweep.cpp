// Solves many scenes, each a task of its own; see --help.

#include <algorithm>
#include <boost/program_options/errors.hpp>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/errors.h"
#include "base/exit_status.h"
#include "base/standard_output.h"
#include "base/worker_processes.h"
#include "commands/run_tasks.h"
#include "commands/sweep_arguments.h"
#include "commands/sweep_file.h"
#include "commands/sweep_store.h"
#include "commands/worker.h"

namespace microinjection {
namespace {

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
  try {
    const SweepArguments arguments = parseSweepArguments(argc, argv);
    if (arguments.show_help) std::cout << arguments.help;
    const int status = arguments.show_help ? kDone : sweep(arguments);
    flushStandardOutput();
    return status;
  } catch (const boost::program_options::error& error) {
    std::cerr << "sweep: " << error.what() << "; see --help\n";
    return kBadUsage;
  } catch (const UserError& error) {
    std::cerr << "sweep: " << error.what() << '\n';
    return kBadUsage;
  } catch (const std::exception& error) {
    std::cerr << "sweep: " << error.what() << '\n';
    return kFailed;
  }
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) { return microinjection::run(argc, argv); }
