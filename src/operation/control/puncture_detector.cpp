#include "operation/control/puncture_detector.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr int kShortest = 4, kLongest = 256, kWindows = 7;
constexpr int kRough = 64;                 ///< longest window in which the speed may fall to half
constexpr double kSmallestAdvance = 1e-9;  ///< m a sample: 1 um/s at 1 kHz
constexpr double kMissed = 2.05;           ///< normal quantile of one miss in 50

}  // namespace

PunctureDetector::PunctureDetector(const ForceNoise& noise, double drop_share, double false_rate, int pause)
    : deviation_(noise.deviation()),
      drop_share_(drop_share),
      quantile_(normalQuantile(false_rate / kWindows)),
      ring_(2 * kLongest + 1),
      pause_(pause) {}

bool PunctureDetector::step(double force, double travel) {
  if (paused_ > 0) {
    --paused_;
    return false;
  }
  if (count_ == 0) ring_[0] = {0, 0, travel}, count_ = 1;
  const Sample sums = before(0);
  ++count_;
  ring_[static_cast<std::size_t>(count_ - 1) % ring_.size()] = {sums.force_sum + force, sums.travel_sum + travel,
                                                                travel};
  for (int window = kShortest; window <= kLongest && 2 * window < count_; window *= 2) {
    if (!fell(window)) continue;
    reset();
    paused_ = pause_;
    return true;
  }
  return false;
}

bool PunctureDetector::fell(int window) const {
  const Sample &now = before(0), &middle = before(window), &old = before(2 * window);
  const double advance = now.travel - middle.travel, earlier = middle.travel - old.travel;
  const double kept = window <= kRough ? 0.5 : 0.9;
  if (earlier < window * kSmallestAdvance || advance < window * kSmallestAdvance || advance < kept * earlier)
    return false;
  // A trembling hand may end deeper although it was less deep on average.
  if (now.travel_sum - middle.travel_sum <= middle.travel_sum - old.travel_sum) return false;
  const double mean = (now.force_sum - middle.force_sum) / window,
               mean_before = (middle.force_sum - old.force_sum) / window;
  const double fall = mean_before - mean;
  return fall > quantile_ * deviation_ * std::sqrt(2.0 / window) && fall > drop_share_ * mean_before;
}

double PunctureDetector::latency(double force) const {
  const double fall = drop_share_ * std::max(force, 0.1 * deviation_);
  const double ratio = (quantile_ + kMissed) * deviation_ / fall;
  return std::max<double>(kShortest, 2 * ratio * ratio);
}

double PunctureDetector::meanForce(int samples) const {
  const int there = static_cast<int>(std::min<long>(samples, count_ - 1));
  return there > 0 ? (before(0).force_sum - before(there).force_sum) / there : 0;
}

}  // namespace microinjection
