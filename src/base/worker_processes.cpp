#include "base/worker_processes.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>
#include <map>
#include <stdexcept>

extern char** environ;

namespace microinjection {
namespace {

/// Child processes. The destructor ends those that still run.
class Children {
 public:
  ~Children() {
    for (const auto& child : indices_) kill(child.first, SIGTERM);
    for (const auto& child : indices_) waitpid(child.first, nullptr, 0);
  }

  std::size_t count() const { return indices_.size(); }

  void start(std::size_t index, const std::vector<std::string>& command) {
    std::vector<char*> arguments, variables;
    for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    std::string blas = "OPENBLAS_NUM_THREADS=1", openmp = "OMP_NUM_THREADS=1";
    variables = {blas.data(), openmp.data()};
    for (char** variable = environ; *variable != nullptr; ++variable) variables.push_back(*variable);
    variables.push_back(nullptr);
    pid_t pid = 0;
    const int error = posix_spawn(&pid, command.front().c_str(), nullptr, nullptr, arguments.data(), variables.data());
    if (error != 0) throw std::runtime_error("cannot start " + command.front() + ": " + std::strerror(error));
    indices_[pid] = index;
  }

  std::pair<std::size_t, int> wait() {
    int status = 0;
    for (;;) {
      const pid_t pid = ::waitpid(-1, &status, 0);
      if (pid < 0 && errno != EINTR) throw std::runtime_error(std::string("waitpid: ") + std::strerror(errno));
      const auto found = indices_.find(pid);
      if (found == indices_.end()) continue;
      const std::size_t index = found->second;
      indices_.erase(found);
      return {index, WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status)};
    }
  }

 private:
  std::map<pid_t, std::size_t> indices_;
};

}  // namespace

void runWorkers(const std::vector<std::vector<std::string>>& commands, int jobs,
                const std::function<void(std::size_t, int)>& ended) {
  Children children;
  std::size_t next = 0;
  while (next < commands.size() || children.count() > 0) {
    while (next < commands.size() && children.count() < static_cast<std::size_t>(jobs)) {
      children.start(next, commands[next]);
      ++next;
    }
    const auto [index, status] = children.wait();
    ended(index, status);
  }
}

std::string thisProgram() {
  char path[PATH_MAX];
  const ssize_t length = readlink("/proc/self/exe", path, sizeof(path));
  if (length <= 0) throw std::runtime_error("cannot read /proc/self/exe");
  return std::string(path, static_cast<std::size_t>(length));
}

}  // namespace microinjection
