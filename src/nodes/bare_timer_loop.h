#pragma once

#include <atomic>
#include <thread>

#include "base/interval_histogram.h"

namespace microinjection {

/// A thread that does nothing but sleep for a millisecond at a time and notes how long it slept: what this machine
/// allows any 1 kHz loop, measured in the same run as what is compared with it.
class BareTimerLoop {
 public:
  BareTimerLoop();
  ~BareTimerLoop() { stop(); }
  BareTimerLoop(const BareTimerLoop&) = delete;
  BareTimerLoop& operator=(const BareTimerLoop&) = delete;

  /// Ends the loop; returns the intervals between its wake-ups, s.
  const IntervalHistogram& stop();

 private:
  void run();
  std::atomic<bool> stop_{false};
  IntervalHistogram intervals_;
  std::thread thread_;
};

}  // namespace microinjection
