#include "commands/prepare_arguments.h"

#include <algorithm>
#include <boost/program_options.hpp>
#include <thread>

#include "base/command_line.h"
#include "base/errors.h"
#include "base/output_files.h"

namespace microinjection {
namespace {

constexpr char kHelp[] =
    R"(prepare: the off-line stage. Solves a scene's cell at many contact points and displacements, and stores the data
with which a live session evaluates a converged force in microseconds.

Usage: prepare --scene FILE [--jobs N] [...]
       prepare --family FILE [--members N | --check N] [--jobs N]
       prepare --family FILE --members N --list PLAN      writes the tasks of the next round of members
       prepare --family FILE --plan PLAN --task K [--count N]   solves some of them
       prepare --family FILE --members N --plan PLAN --gather   adds the members, when all tasks are done

Takes minutes, shows its progress, and may be interrupted: the next call continues from the finished paths. The data are
in $XDG_CACHE_HOME (else ~/.cache) under cell_microinjection/surrogates, in a folder named after the cell, the tip and
the program's version. Cells that differ in scale, or whose moduli and tensions differ by one factor, have the same data.
Another tip, another ratio of lengths or another ratio of moduli needs its own; another needle offset does not. A scene
whose puncture has a toughness is solved with holes first, in a minute.

With --family it solves members of a family of cells, each in minutes, and stores the family's data beside its file (NAME.data
beside NAME.yaml). Every cell inside of the family is then served at once, without a preparation. The members are where
the prediction from the solved ones is least certain. Several processes with one cache share the work. With --list, --task
and --gather a job scheduler does it, round by round: see doc/guide/cluster.md. Families of sections
(config/families/tongues, held, friction, withdrawal, pierced) are solved in the same way, in seconds a member, with --members and --jobs only. A task
that another process solves at the moment ends with status 4: try it again.

Data that are damaged, or of another version, are reported and replaced.

Where the cell has no solution in a part of the range, the range shrinks, which is reported.

Exit status: 0 prepared (or was already); 2 bad usage, a scene that cannot be prepared (adhesion that no family has, a viscosity that
does not relax, a sharp disc on a nonlinear cell, tensegrity: the message names it), or data or output that cannot be written
(the message names the path and the reason; the folder is checked first); 3 a path ends before a fifth of its length: nothing
is stored.

Options)";

void requireAtLeast(const std::string& option, int value, int least) {
  if (value >= least) return;
  throw ConfigError("--" + option + " = " + std::to_string(value) + ": must be " + std::to_string(least) + " or more");
}

/// `task`: whether --task was given.
void requirePlan(const PrepareArguments& arguments, bool task) {
  const bool plan = !arguments.family.plan.empty();
  if (plan && !arguments.family.list.empty()) throw ConfigError("--list and --plan: only one may be given");
  if (task && arguments.gather) throw ConfigError("--task and --gather: only one may be given");
  if (!plan && task) throw ConfigError("--task needs --plan: a file that --list has written");
  if (!plan && arguments.gather) throw ConfigError("--gather needs --plan: a file that --list has written");
  if (plan && !task && !arguments.gather) throw ConfigError("--plan needs one of --task and --gather");
}

}  // namespace

std::optional<PrepareArguments> parsePrepareArguments(int argc, char** argv) {
  namespace po = boost::program_options;
  PrepareArguments arguments;
  const int processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  po::options_description visible;
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
      "list", po::value(&family.list), "file for the tasks of the family's next round; CSV")(
      "plan", po::value(&family.plan), "file that --list has written")("task", po::value(&arguments.task),
                                                                       "of the plan to solve, from 0")(
      "count", po::value(&arguments.count)->default_value(arguments.count),
      "tasks to solve from there; the plan's end ends it")("gather", po::bool_switch(&arguments.gather),
                                                           "adds the plan's members to the family's data")(
      "jobs", po::value(&arguments.jobs)->default_value(processors), "paths solved at a time, each on one core")(
      "again", po::bool_switch(&arguments.again), "replaces data that were prepared before");
  po::options_description hidden;
  hidden.add_options()("ray", po::value(&arguments.ray), "solves only this path, as a worker process")(
      "at", po::value(&arguments.at), "of the family's member at these coordinates")(
      "member", po::value(&arguments.member), "of this member of the check")(
      "axis", po::value(&arguments.axis), "solves only this node of the family's grid on the axis");
  po::variables_map values;
  if (!readCommandLine(wordsOf(argc, argv), visible, kHelp, values, "", 1, hidden)) return std::nullopt;
  if (arguments.scene.empty() == family.file.empty()) throw ConfigError("one of --scene and --family must be given");
  requirePlan(arguments, values.count("task") != 0);
  family.members_given = !values["members"].defaulted();
  if (family.file.empty() && !(family.plan + family.list).empty()) throw ConfigError("--list and --plan need --family");
  if (values.count("task") != 0) requireAtLeast("task", arguments.task, 0);
  requireAtLeast("count", arguments.count, 1);
  requireAtLeast("jobs", arguments.jobs, 1);
  requireAtLeast("members", family.members, 1);
  requireAtLeast("check", family.check, 0);
  OutputFiles()
      .reads("--scene", arguments.scene)
      .reads("--family", family.file)
      .reads("--plan", family.plan)
      .writes("--csv", family.csv)
      .writes("--reference", family.reference)
      .writes("--list", family.list)
      .check();
  family.jobs = arguments.jobs;
  return arguments;
}

}  // namespace microinjection
