#include "base/cpu_time.h"

#include <gtest/gtest.h>

#include <thread>

namespace microinjection {
namespace {

long nanoseconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1000000000L * time.tv_sec + time.tv_nsec;
}

/// In a thread of its own, whose time is not that of the process.
TEST(CpuTime, IsThatOfTheCallingThreadInSeconds) {
  long before = 0, after = 0;
  double found = 0;
  std::thread([&] {
    before = nanoseconds();
    found = threadCpuTime();
    after = nanoseconds();
  }).join();
  EXPECT_GE(found, 1e-9 * static_cast<double>(before) - 1e-15);
  EXPECT_LE(found, 1e-9 * static_cast<double>(after) + 1e-15);
  EXPECT_GT(found, 0);
}

}  // namespace
}  // namespace microinjection
