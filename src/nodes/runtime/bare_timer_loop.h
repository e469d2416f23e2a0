#pragma once

#include <atomic>
#include <thread>

#include "base/interval_histogram.h"
#include "base/latest_value.h"

namespace microinjection {

/// A thread that does nothing but sleep for a millisecond at a time and notes how long it slept: what this machine
/// allows any 1 kHz loop that runs in real time as the nodes of the hand's loop do, measured in the same run as what is
/// compared with it.
class BareTimerLoop {
 public:
  BareTimerLoop();
  ~BareTimerLoop();
  BareTimerLoop(const BareTimerLoop&) = delete;
  BareTimerLoop& operator=(const BareTimerLoop&) = delete;

  /// Intervals between its wake-ups so far, s. In one thread only.
  const IntervalHistogram& intervals();

 private:
  void run();
  std::atomic<bool> stop_{false};
  LatestValue<IntervalHistogram> intervals_;
  std::thread thread_;
};

}  // namespace microinjection
