#include "operation/control/puncture_detector.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr int kShortest = 4, kLongest = 256;
constexpr int kLags[] = {0, 1, 2, 4};      ///< windows between those that are compared
constexpr int kTests = 28;                 ///< a sample, of windows and lags
constexpr int kSpan = 2048;                ///< samples that are kept
constexpr int kHistory = 3;                ///< and over this many times what is compared: fast motion relaxes
constexpr int kRough = 64;                 ///< longest window in which the speed may fall to half
constexpr double kKept = 0.9;              ///< of the speed, in the others
constexpr double kSteadyShare = 0.4;       ///< of the smallest fall, while the needle goes steadily,
constexpr int kSettled = 64;               ///< from this many samples after a puncture, whose remaining force falls on
constexpr double kSmallestAdvance = 1e-9;  ///< m a sample: 1 um/s at 1 kHz
constexpr double kMissed = 2.05;           ///< normal quantile of one miss in 50

}  // namespace

PunctureDetector::PunctureDetector(const ForceNoise& noise, double drop_share, double false_rate, int pause)
    : deviation_(noise.deviation()),
      drop_share_(drop_share),
      quantile_(normalQuantile(false_rate / kTests)),
      ring_(kSpan + 1),
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
  for (int window = kShortest; window <= kLongest; window *= 2) {
    for (const int lag : kLags) {
      if ((2 + lag) * window >= count_ || !fell(window, lag * window)) continue;
      reset();
      paused_ = pause_;
      return true;
    }
  }
  return false;
}

bool PunctureDetector::fell(int window, int lag) const {
  const Sample &now = before(0), &middle = before(window), &end = before(window + lag), &old = before(2 * window + lag);
  const double mean = (now.force_sum - middle.force_sum) / window, earlier = (end.force_sum - old.force_sum) / window;
  const double fall = earlier - mean;
  if (fall <= quantile_ * deviation_ * std::sqrt(2.0 / window) || fall <= kSteadyShare * drop_share_ * earlier)
    return false;
  const double advance = now.travel - middle.travel, advance_before = end.travel - old.travel;
  if (std::min(advance, advance_before) < window * kSmallestAdvance) return false;
  // A trembling hand may end deeper although it was less deep on average.
  if (now.travel_sum - middle.travel_sum <= end.travel_sum - old.travel_sum) return false;
  const double kept = window <= kRough ? 0.5 : kKept;
  const bool far = lag == 0 && fall > drop_share_ * earlier && advance >= kept * advance_before;
  return far || isSteady(window, lag);
}

bool PunctureDetector::isSteady(int window, int lag) const {
  const int oldest = static_cast<int>(std::min<long>(kSpan, count_ - 1));
  if (oldest < kSettled + kHistory * (2 * window + lag)) return false;
  const auto speed = [&](int end) {  // of the block of a window's length that ends there
    const int begin = std::min(end + window, oldest);
    return (before(end).travel - before(begin).travel) / (begin - end);
  };
  const double fastest = speed(0) / kKept, slowest = kKept * speed(window + lag);
  for (int end = window; end < oldest; end += window) {
    const double each = speed(end);
    if (each > fastest || (end < window + lag && each < slowest)) return false;
  }
  return true;
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
