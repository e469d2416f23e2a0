#include "commands/sweep_arguments.h"

#include <algorithm>
#include <boost/program_options.hpp>
#include <sstream>
#include <thread>

#include "base/errors.h"

namespace microinjection {
namespace {

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

}  // namespace

SweepArguments parseSweepArguments(int argc, char** argv) {
  namespace po = boost::program_options;
  SweepArguments arguments;
  const int processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  po::options_description visible("", 118), hidden, all;
  visible.add_options()("help", "this text")("file", po::value(&arguments.file), "sweep file (YAML)")(
      "out", po::value(&arguments.out), "folder of the results")("list", po::bool_switch(&arguments.list),
                                                                 "prints the tasks as CSV, solves nothing")(
      "task", po::value(&arguments.task), "first task to solve, from 0")(
      "count", po::value(&arguments.count)->default_value(1), "tasks to solve from there; the sweep's end ends it")(
      "gather", po::bool_switch(&arguments.gather), "only writes the table")(
      "jobs", po::value(&arguments.jobs)->default_value(processors), "tasks at a time, each on one core");
  hidden.add_options()("worker", po::bool_switch(&arguments.worker), "ends with the process that started it");
  all.add(visible).add(hidden);
  po::variables_map values;
  po::store(po::command_line_parser(argc, argv).options(all).positional({}).run(), values);
  po::notify(values);
  std::ostringstream help;
  help << kSweepHelp << visible;
  arguments.help = help.str();
  arguments.show_help = values.count("help") != 0;
  if (arguments.show_help) return arguments;
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

}  // namespace microinjection
