#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace microinjection {

/// Exit status of a worker whose task is being solved by another process.
constexpr int kBusyStatus = 4;

/// A command that does a number of tasks.
struct Work {
  std::vector<std::string> command;
  std::size_t tasks = 1;
};

/// Runs the commands of `missing` as worker processes, `jobs` at a time, until it returns none, with
/// a line of progress on stderr that counts `unit`. Tasks of another process are waited for. Throws
/// ConfigError when a worker ends with status 2, std::runtime_error with another one.
void runTasks(const std::string& title, const std::string& unit, int jobs,
              const std::function<std::vector<Work>()>& missing);

/// Prepares a process that solves one piece of a larger work: one thread, and a memory allocator
/// that keeps large blocks. `ends_with_parent`: it is killed when its parent ends.
void prepareWorker(bool ends_with_parent);

}  // namespace microinjection
