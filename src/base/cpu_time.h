#pragma once

#include <ctime>

namespace microinjection {

/// Processor time (s) of the calling thread. It does not include time in which other processes ran.
inline double threadCpuTime() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace microinjection
