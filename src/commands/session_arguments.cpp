#include "commands/session_arguments.h"

#include <boost/program_options.hpp>
#include <iostream>
#include <sstream>

#include "base/command_line.h"
#include "base/config_errors.h"
#include "base/errors.h"
#include "base/output_files.h"
#include "base/standard_output.h"

namespace microinjection {
namespace {

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

}  // namespace

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

}  // namespace microinjection
