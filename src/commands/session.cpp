#include "session/session.h"

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>

#include "base/atomic_file.h"
#include "base/cache_file.h"
#include "base/command_line.h"
#include "base/errors.h"
#include "base/exit_status.h"
#include "base/standard_output.h"
#include "commands/session_arguments.h"
#include "session/launch_file.h"
#include "session/surroundings.h"

namespace microinjection {
namespace {

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
