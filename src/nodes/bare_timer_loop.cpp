#include "nodes/bare_timer_loop.h"

#include <time.h>

namespace microinjection {
namespace {

double seconds(const timespec& time) {
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

BareTimerLoop::BareTimerLoop() : thread_([this] { run(); }) {}

const IntervalHistogram& BareTimerLoop::stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
  return intervals_;
}

void BareTimerLoop::run() {
  timespec due, woke;
  clock_gettime(CLOCK_MONOTONIC, &due);
  double before = seconds(due);
  while (!stop_) {
    due.tv_nsec += 1000000;
    if (due.tv_nsec >= 1000000000) {
      due.tv_nsec -= 1000000000;
      ++due.tv_sec;
    }
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr);
    clock_gettime(CLOCK_MONOTONIC, &woke);
    intervals_.add(seconds(woke) - before);
    before = seconds(woke);
    if (before - seconds(due) > 0.01) due = woke;  // after a stall: do not catch up
  }
}

}  // namespace microinjection
