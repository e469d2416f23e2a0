#include "benchmark/common/forked_case.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <exception>
#include <iostream>
#include <stdexcept>

namespace microinjection {

ForkedCase runForked(const std::function<std::string()>& work, unsigned seconds) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe to a child process");
  std::cout.flush();
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no child process");
  if (child == 0) {
    close(ends[0]);
    alarm(seconds);
    int status = 0;
    std::string output;
    try {
      output = work();
    } catch (const std::exception& exception) {
      std::cerr << exception.what() << std::endl;
      status = 1;
    }
    for (std::size_t done = 0; done < output.size();) {
      const ssize_t count = write(ends[1], output.data() + done, output.size() - done);
      if (count <= 0) _exit(2);
      done += static_cast<std::size_t>(count);
    }
    _exit(status);
  }
  close(ends[1]);
  ForkedCase result;
  std::array<char, 4096> buffer{};
  for (ssize_t count; (count = read(ends[0], buffer.data(), buffer.size())) > 0;) {
    result.output.append(buffer.data(), static_cast<std::size_t>(count));
  }
  close(ends[0]);
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  result.memory_megabytes = static_cast<double>(usage.ru_maxrss) / 1024;
  if (WIFSIGNALED(status)) result.failure = WTERMSIG(status) == SIGALRM ? "out of time" : "crashed";
  if (WIFEXITED(status) && WEXITSTATUS(status) != 0) result.failure = "failed";
  return result;
}

}  // namespace microinjection
