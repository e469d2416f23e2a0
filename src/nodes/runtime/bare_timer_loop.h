#pragma once

#include <atomic>
#include <thread>

#include "base/interval_histogram.h"
#include "base/latest_value.h"

namespace microinjection {

/// A real-time thread that only sleeps for a millisecond at a time and measures the intervals. They
/// are this machine's limit for the nodes' 1 kHz loops, measured in the same run.
class BareTimerLoop {
 public:
  BareTimerLoop();
  ~BareTimerLoop();
  BareTimerLoop(const BareTimerLoop&) = delete;
  BareTimerLoop& operator=(const BareTimerLoop&) = delete;

  /// Intervals (s) between its wake-ups so far. Call from one thread only.
  const IntervalHistogram& intervals();

 private:
  void run();
  std::atomic<bool> stop_{false};
  LatestValue<IntervalHistogram> intervals_;
  std::thread thread_;
};

}  // namespace microinjection
