#include "cell/estimation/sample_history.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/median.h"

namespace microinjection {
namespace {

SampleHistory::Sample joined(const SampleHistory::Sample& a, const SampleHistory::Sample& b) {
  SampleHistory::Sample both;
  both.readings = a.readings + b.readings;
  const double share = static_cast<double>(b.readings) / both.readings;
  both.time = a.time + share * (b.time - a.time);
  both.tip = a.tip + share * (b.tip - a.tip);
  both.force = a.force + share * (b.force - a.force);
  // Of the noise alone: the means of two samples differ because the tip has moved.
  both.scatter = a.scatter + b.scatter;
  return both;
}

// Two samples at rest are apart as little as this share of two on the path: a needle that rests for a
// minute must not drive out the path on which the force rose.
constexpr double kRest = 0.01;

}  // namespace

void SampleHistoryConfig::read(ConfigReader& reader) {
  reader.number("spacing", spacing, Range::positive());
  reader.number("duration", duration, Range::positive());
  reader.integer("capacity", capacity, Range::closed(40, 2000));
}

void SampleHistory::add(double time, const Eigen::Vector3d& tip, double force) {
  const bool next = samples_.empty() || (tip - start_).norm() >= spacing_ || time - begun_ >= config_.duration;
  if (next) {
    if (samples_.size() >= static_cast<std::size_t>(config_.capacity)) thin();
    samples_.push_back({time, tip, force, 0, 1});
    begun_ = time;
    start_ = tip;
    return;
  }
  // Welford's update keeps mean and scatter without the readings.
  Sample& sample = samples_.back();
  const double before = force - sample.force, share = 1.0 / ++sample.readings;
  sample.time += share * (time - sample.time);
  sample.tip += share * (tip - sample.tip);
  sample.force += share * before;
  sample.scatter += before * (force - sample.force);
}

void SampleHistory::thin() {
  const auto apart = [&](std::size_t i) {
    const double path = (samples_[i + 1].tip - samples_[i].tip).norm() / spacing_;
    return path + kRest * (samples_[i + 1].time - samples_[i].time) / config_.duration;
  };
  std::vector<double> distances;
  for (std::size_t i = 0; i + 1 < samples_.size(); ++i) distances.push_back(apart(i));
  const double near = upperMedian(distances);
  std::vector<Sample> fewer;
  fewer.reserve(samples_.capacity());
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const bool join = i + 1 < samples_.size() && distances[i] <= near;
    fewer.push_back(join ? joined(samples_[i], samples_[i + 1]) : samples_[i]);
    if (join) ++i;
  }
  samples_ = std::move(fewer);
  if (near > 0.5) spacing_ *= 2;
}

void SampleHistory::forgetBefore(double time) {
  const auto first = std::find_if(samples_.begin(), samples_.end(), [&](const Sample& s) { return s.time >= time; });
  if (first == samples_.begin()) return;
  samples_.erase(samples_.begin(), std::prev(first));
}

void SampleHistory::forgetSince(double time) {
  while (!samples_.empty() && samples_.back().time >= time) samples_.pop_back();
  if (samples_.empty()) return;
  begun_ = -std::numeric_limits<double>::infinity();  // the next reading begins a sample
}

void SampleHistory::clear() {
  samples_.clear();
  spacing_ = config_.spacing;
}

double SampleHistory::noise() const {
  double scatter = 0, freedom = 0;
  for (const Sample& sample : samples_) {
    scatter += sample.scatter;
    freedom += std::max(0, sample.readings - 1);
  }
  // A thinned sample has lost one degree of freedom more, which is too little to matter.
  constexpr double kFewest = 20;
  return freedom >= kFewest ? std::sqrt(scatter / freedom) : 0;
}

}  // namespace microinjection
