#include <boost/program_options.hpp>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "base/command_line.h"
#include "base/errors.h"
#include "base/exit_status.h"
#include "base/standard_output.h"
#include "nodes/executive/simulation.h"

namespace {

using namespace microinjection;

constexpr char kHelp[] = R"(usage: simulate [FILE] [KEY:=VALUE...] [OPTION...]

Runs a session to its end on virtual time: all nodes in this process, without a ROS master, as fast as one core allows,
the same bytes in each run. FILE is a session file or a name of config/sessions (default: default). KEY:=VALUE overrides
its keys: cell:=mouse_oocyte hand.device:=none record.folder:=out/run

A session ends when the hand's motion is done, when an automatic injection is, or after --duration. It leaves what
record/folder says: force_depth.csv, summary.yaml, session.bag.

Exit status: 0 done; 2 a session that cannot be, or needs a device, a display or a person; 3 a node ended by an error,
or the session did not end.
)";

struct Arguments {
  std::string session = "default";
  std::vector<std::string> overrides;
  SimulationConfig config;
  bool quiet = false;
};

std::optional<Arguments> parse(int argc, char** argv) {
  namespace po = boost::program_options;
  Arguments arguments;
  std::vector<std::string> own;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool is_key = word[0] != '-' && word.find('=') != std::string::npos;
    (is_key ? arguments.overrides : own).push_back(word);
  }
  po::options_description options("Options");
  auto add = options.add_options();
  add("help,h", "this text");
  add("session", po::value(&arguments.session)->value_name("FILE"), "the session; the option's name may be left out");
  add("record", po::value<std::string>()->value_name("FOLDER"), "the same as record.folder:=FOLDER");
  add("duration", po::value(&arguments.config.duration)->value_name("S"),
      "s of the session; default: until it is done");
  add("limit", po::value(&arguments.config.limit)->value_name("S"), "s in which it must be done (600)");
  add("quiet,q", po::bool_switch(&arguments.quiet), "no progress");
  po::variables_map given;
  if (!readCommandLine(own, options, std::string(kHelp) + '\n', given, "session")) return std::nullopt;
  if (given.count("record")) arguments.overrides.push_back("record.folder:=" + given["record"].as<std::string>());
  for (const double seconds : {arguments.config.duration, arguments.config.limit}) {
    if (!(seconds >= 0)) throw ConfigError("--duration, --limit: must be at least 0 s");
  }
  return arguments;
}

int run(const Arguments& arguments) {
  const Session session = Session::load(arguments.session, arguments.overrides);
  const auto show = [&](double time) {
    if (!arguments.quiet) std::fprintf(stderr, "\rsimulate: %.1f s", time);
  };
  const SimulationResult result = simulate(session, arguments.config, show);
  if (!arguments.quiet) std::fputc('\n', stderr);
  for (const std::string& warning : result.warnings) std::fprintf(stderr, "simulate: %s\n", warning.c_str());
  for (const std::string& failure : result.failures) std::fprintf(stderr, "simulate: %s\n", failure.c_str());
  std::printf("%.2f s of the session in %.2f s, %.1f times real time%s%s%s%s\n", result.simulated, result.took,
              result.simulated / result.took, result.outcome.empty() ? "" : "; injection: ", result.outcome.c_str(),
              session.record.folder.empty() ? "" : "; recorded in ", session.record.folder.c_str());
  flushStandardOutput();
  return result.failures.empty() && result.done ? kDone : kFailed;
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("simulate", [&] {
    const std::optional<Arguments> arguments = parse(argc, argv);
    return arguments ? run(*arguments) : kDone;
  });
}
