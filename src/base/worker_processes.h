#pragma once

#include <functional>
#include <string>
#include <vector>

namespace microinjection {

/// Runs commands, at most `jobs` at a time, each in a process of its own with one thread for linear
/// algebra. A command is a program's path and its arguments. Calls `ended` for each command that
/// ends, with its index and exit status (128 + signal when it was killed). When `ended` throws, or
/// a start fails (std::runtime_error), the other processes are killed.
void runWorkers(const std::vector<std::vector<std::string>>& commands, int jobs,
                const std::function<void(std::size_t index, int status)>& ended);

/// Path of the running program.
std::string thisProgram();

}  // namespace microinjection
