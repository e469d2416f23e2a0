#pragma once

#include <functional>
#include <string>

namespace microinjection {

/// What came of a case that ran in a process of its own.
struct ForkedCase {
  std::string output;           ///< what the case returned; empty when it did not end well
  std::string failure;          ///< crashed or out of time; else empty
  double memory_megabytes = 0;  ///< peak, resident
};

/// Runs `work` in a child process, so that its memory is its own and neither a crash nor a hang
/// ends the benchmark.
ForkedCase runForked(const std::function<std::string()>& work, unsigned seconds);

}  // namespace microinjection
