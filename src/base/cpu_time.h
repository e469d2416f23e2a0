#pragma once

#include <ctime>

namespace microinjection {

/// s of processor time that the calling thread has had: stalls of the machine do not count.
inline double threadCpuTime() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace microinjection
