#include "session/surroundings.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstring>
#include <sstream>

namespace microinjection {
namespace {

using Variables = std::function<const char*(const char*)>;

std::string textOf(const Variables& variable, const char* name) {
  const char* value = variable(name);
  return value ? value : "";
}

bool hasRviz(const SessionPlan& plan) {
  return std::any_of(plan.processes.begin(), plan.processes.end(),
                     [](const ForeignProcess& process) { return process.program == "rviz"; });
}

/// `name` begins with a zero byte for an abstract socket.
bool listens(const std::string& name) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (name.size() >= sizeof(address.sun_path)) return false;
  std::memcpy(address.sun_path, name.data(), name.size());
  const int descriptor = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return true;  // unknown
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
  const bool connected = connect(descriptor, reinterpret_cast<const sockaddr*>(&address), size) == 0;
  close(descriptor);
  return connected;
}

/// Of a display of this machine, ":1" or ":1.0"; whether one behind a network answers is not asked.
std::string problemOfDisplay(const std::string& display) {
  if (display.empty()) return "the environment has no DISPLAY";
  if (display[0] != ':') return "";
  std::string number = display.substr(1, display.find('.') - 1);
  const bool is_number = !number.empty() && std::all_of(number.begin(), number.end(),
                                                        [](unsigned char each) { return std::isdigit(each); });
  const std::string path = "/tmp/.X11-unix/X" + number;
  if (is_number && (listens(path) || listens(std::string(1, '\0') + path))) return "";
  return "no X server answers on DISPLAY = " + display;
}

/// The first program of this name on a PATH; empty: none.
std::string firstOnPath(const std::string& name, const std::string& path) {
  std::istringstream folders(path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string program = folder + "/" + name;
    if (!folder.empty() && access(program.c_str(), X_OK) == 0) return program;
  }
  return "";
}

}  // namespace

std::vector<std::string> surroundingsWarnings(const SessionPlan& plan, const Variables& variable) {
  std::vector<std::string> warnings;
  const std::string problem = hasRviz(plan) ? problemOfDisplay(textOf(variable, "DISPLAY")) : "";
  if (!problem.empty())
    warnings.push_back(problem +
                       ": rviz ends at once on this machine, and the needle goes on unseen. Begin the session " +
                       "on a desktop or with ssh -X, or without rviz: rviz:=false console:=none");
  const std::string conda = textOf(variable, "CONDA_PREFIX");
  const std::string roslaunch = firstOnPath("roslaunch", textOf(variable, "PATH"));
  if (!conda.empty() && roslaunch.rfind(conda + "/", 0) == 0)
    warnings.push_back(roslaunch + " comes first on the PATH: the ROS of conda is not the one that this package was " +
                       "built with, and starts its own rviz and tools. conda deactivate, or ./dev shell");
  return warnings;
}

}  // namespace microinjection
