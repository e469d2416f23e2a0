#pragma once

#include <functional>
#include <string>
#include <vector>

namespace microinjection {

/// Exit status of a worker whose path is being solved by another process.
constexpr int kBusyStatus = 4;

/// Runs the commands of `missing` as worker processes, `jobs` at a time, until it returns none, with
/// a line of progress on stderr. Paths of another process are waited for. Throws ConfigError when a
/// worker ends with status 2, std::runtime_error with another one.
void solvePaths(const std::string& title, int jobs,
                const std::function<std::vector<std::vector<std::string>>()>& missing);

}  // namespace microinjection
