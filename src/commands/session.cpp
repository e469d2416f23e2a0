#include <boost/program_options.hpp>

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/cache_file.h"
#include "base/command_line.h"
#include "base/config_errors.h"
#include "base/errors.h"
#include "base/output_files.h"
#include "base/standard_output.h"
#include "session/launch_file.h"
#include "session/session.h"
#include "session/surroundings.h"

namespace microinjection {
namespace {

struct SessionArguments {
  std::string session = "default";    ///< a file, or a name of config/sessions
  std::vector<std::string> keys;      ///< KEY:=VALUE
  std::string launch, view;           ///< files to write; empty: none
  bool print = false, nodes = false;  ///< prints the session, its nodes
  std::vector<std::string> only;      ///< nodes; empty: all
};

constexpr char kHelp[] = R"(session: checks a session file, prints it, and writes what roslaunch needs to start it.

Usage: session [SESSION] [KEY:=VALUE ...] [--print | --nodes | --launch OUT | --view OUT] [--only "NODE ..."]

SESSION is a file, or a name of config/sessions (default). KEY:=VALUE, or KEY=VALUE, sets one of its keys, such as
hand.device:=keyboard; a list or a map is YAML. A key without a value is passed over. config/sessions/default.yaml has
all keys. A path in a file is relative to that file, one in KEY:=VALUE to the working directory.

Without an option it only checks. What is wrong is told with file, line, key, value and what is allowed, all at once.

Examples:
  session lab.yaml
  session lab.yaml hand.device:=keyboard record.folder:=today --print
  session injection --launch /tmp/session.launch

Exit status: 0 good; 2 wrong option or session, or output that cannot be written (the message names it).

)";

/// __name:=... and the like.
bool isOfRoslaunch(const std::string& argument) { return argument.rfind("__", 0) == 0; }

/// Nothing after printing the help. Ignores the arguments that roslaunch adds. Throws ConfigError.
std::optional<SessionArguments> parseSessionArguments(int argc, char** argv) {
  namespace po = boost::program_options;
  SessionArguments arguments;
  std::vector<std::string> options_given, positional;
  std::string only;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool is_key = argument.rfind("--", 0) != 0 && argument.find('=') != std::string::npos;
    if (!is_key) {
      options_given.push_back(argument);
    } else if (!isOfRoslaunch(argument)) {
      arguments.keys.push_back(argument);
    }
  }
  po::options_description options("Options");
  auto add = options.add_options();
  add("help,h", "this text");
  add("session", po::value(&positional)->value_name("FILE"), "the session; the option's name may be left out");
  add("check", "only checks, which is what it does without an option");
  add("print", po::bool_switch(&arguments.print), "prints the session with all keys, a file that is the same session");
  add("nodes", po::bool_switch(&arguments.nodes), "prints the names of its nodes, one a line");
  add("launch", po::value(&arguments.launch)->value_name("OUT"),
      "writes a roslaunch file, and prints a digest of all files that the session is made from");
  add("view", po::value(&arguments.view)->value_name("OUT"), "writes the configuration of the session's rviz");
  add("only", po::value(&only)->value_name("NODES"), "names separated by spaces: nothing else takes part; empty: all");
  po::variables_map given;
  if (!readCommandLine(options_given, options, kHelp, given, "session", -1)) return std::nullopt;
  ConfigErrors errors;
  errors.require(positional.size() < 2, "SESSION", join(positional, " "), "", "one file or name");
  errors.require(given.count("launch") == 0 || !arguments.launch.empty(), "--launch", "", "", "the path of a file");
  errors.throwAny();
  if (!positional.empty() && !positional.front().empty()) arguments.session = positional.front();
  OutputFiles()
      .reads("SESSION", arguments.session)
      .writes("--launch", arguments.launch)
      .writes("--view", arguments.view)
      .check();
  std::istringstream names(only);
  for (std::string name; names >> name;) arguments.only.push_back(name);
  return arguments;
}

/// Of all that must be the same on each host of a session: the arguments, and the contents of the files.
std::string digest(const SessionPlan& plan, const SessionArguments& arguments) {
  std::string all = join(arguments.keys, "\n");
  for (const std::string& path : plan.files) {
    std::ifstream file(path);
    all += std::string("\n") + std::string(std::istreambuf_iterator<char>(file), {});
  }
  return contentHash(all);
}

void writeLaunchFile(SessionPlan plan, const SessionArguments& arguments) {
  if (!arguments.only.empty()) plan.keepOnly(arguments.only);
  for (const std::string& warning : surroundingsWarnings(plan, [](const char* name) { return std::getenv(name); }))
    std::cerr << "session: warning: " << warning << '\n';
  const std::string view_file = arguments.launch + ".rviz", view = rvizView(plan);
  if (!view.empty()) writeFileAtomically(view_file, view);
  writeFileAtomically(arguments.launch, launchText(plan, view_file));
}

void writeView(const SessionPlan& plan, const std::string& path) {
  const std::string view = rvizView(plan);
  if (view.empty()) throw ConfigError("--view = " + path + ": must be with a console (display.console)");
  writeFileAtomically(path, view);
}

void run(const SessionArguments& arguments) {
  const Session session = Session::load(arguments.session, arguments.keys);
  SessionPlan plan = planOf(session, SessionClock::kWall);
  const std::string text = plan.text;
  if (!arguments.launch.empty()) {
    writeLaunchFile(plan, arguments);
    std::cout << digest(plan, arguments) << '\n';
  } else if (!arguments.only.empty()) {
    plan.keepOnly(arguments.only);
  }
  if (!arguments.view.empty()) writeView(plan, arguments.view);
  if (arguments.print) std::cout << session.text();
  if (arguments.nodes) std::cout << join(plan.names(), "\n") << '\n';
  flushStandardOutput();
  std::cerr << "session: " << text << '\n';
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  using namespace microinjection;
  return runProgram("session", [&] {
    const std::optional<SessionArguments> arguments = parseSessionArguments(argc, argv);
    if (arguments) run(*arguments);
    return kDone;
  });
}
