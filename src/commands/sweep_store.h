#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/cache_file.h"
#include "commands/sweep_file.h"

namespace microinjection {

/// The results of a sweep, a file each in a folder: with a checksum, and whole or not there. They
/// hold no time and no name of a machine, so that they are the same bytes whoever computes them.
class SweepStore {
 public:
  SweepStore(const SweepFile& sweep, const std::string& folder) : sweep_(sweep), folder_(folder) {}

  /// Solves a task and stores its rows, unless they are there. A task without a solution has rows with
  /// the reason. Throws WriteError when they cannot be stored, and std::runtime_error that names the
  /// task when the machine has no memory or no space for its solution.
  void solve(std::size_t task) const;
  /// Of the `count` tasks from `first` on, those without a usable file; damaged ones are reported on stderr.
  std::vector<std::size_t> missing(std::size_t first, std::size_t count) const;
  /// The table of all tasks, CSV in the order of their numbers. Throws ConfigError when some are missing.
  std::string table() const;

 private:
  std::string file(std::size_t task) const;
  CacheRead<std::string> load(std::size_t task) const;

  const SweepFile& sweep_;
  std::string folder_;
};

}  // namespace microinjection
