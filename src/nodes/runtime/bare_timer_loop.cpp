#include "nodes/runtime/bare_timer_loop.h"

#include <time.h>

#include "nodes/runtime/real_time.h"

namespace microinjection {
namespace {

constexpr long kTimerPeriod = 1000000;  // ns

double seconds(const timespec& time) {
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

BareTimerLoop::BareTimerLoop() : thread_([this] { run(); }) {}

BareTimerLoop::~BareTimerLoop() {
  stop_ = true;
  thread_.join();
}

const IntervalHistogram& BareTimerLoop::intervals() {
  intervals_.update();
  return intervals_.value();
}

void BareTimerLoop::run() {
  preferForThread(Priority::kRealTime);
  IntervalHistogram intervals(2e-9 * kTimerPeriod);  // the limit marks wake-ups late by more than a period
  timespec due, woke;
  clock_gettime(CLOCK_MONOTONIC, &due);
  double before = seconds(due);
  while (!stop_) {
    due.tv_nsec += kTimerPeriod;
    if (due.tv_nsec >= 1000000000) {
      due.tv_nsec -= 1000000000;
      ++due.tv_sec;
    }
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr);
    clock_gettime(CLOCK_MONOTONIC, &woke);
    intervals.add(seconds(woke) - before);
    intervals_.write(intervals);
    before = seconds(woke);
    if (before - seconds(due) > 0.01) due = woke;  // after a stall: do not catch up
  }
}

}  // namespace microinjection
