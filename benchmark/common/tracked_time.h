#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "base/cpu_time.h"
#include "base/median.h"
#include "vision/track/specimen_tracker.h"

namespace microinjection {

/// Processor time (s) of a tracked frame: the median over an image that is seen for 40 frames more. What is missing is
/// searched in some of them only, see SearchPace.
inline double trackedTime(SpecimenTracker& tracker, const cv::Mat& image) {
  constexpr int kFrames = 40;
  std::vector<double> times;
  for (int i = 0; i < kFrames; ++i) {
    const double begin = threadCpuTime();
    tracker.next(Frame(image));
    times.push_back(threadCpuTime() - begin);
  }
  return upperMedian(times);
}

}  // namespace microinjection
