#include "cell/estimation/misfit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/median.h"

namespace microinjection {
namespace {

constexpr int kFewestInContact = 24;  // samples in contact, of a misfit
constexpr int kBlocks = 8;
constexpr double kOfMedian = 1.25;  // deviation of a median over that of a mean
constexpr int kFewestFree = 12;     // samples before contact, of a drift

}  // namespace

Misfit misfitOf(const std::vector<ForcePath::Point>& points, double factor, const Eigen::VectorXd& residuals,
                const Eigen::VectorXd& deviations) {
  std::vector<double> inside, spread;
  double largest = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    largest = std::max(largest, factor * points[i].force);
    if (!points[i].touches || !points[i].prepared) continue;
    inside.push_back(residuals[static_cast<Eigen::Index>(i)]);
    spread.push_back(deviations[static_cast<Eigen::Index>(i)]);
  }
  if (inside.size() < kFewestInContact || !(largest > 0)) return {};
  const auto length = static_cast<std::ptrdiff_t>(inside.size() / kBlocks);
  double squares = 0, expected = 0;
  for (int block = 0; block < kBlocks; ++block) {
    const auto begin = block * length, end = begin + length;
    const double middle = upperMedian({inside.begin() + begin, inside.begin() + end});
    const double deviation = upperMedian({spread.begin() + begin, spread.begin() + end});
    squares += middle * middle;
    expected += deviation * deviation / static_cast<double>(length);
  }
  return {std::sqrt(squares / kBlocks) / largest, kOfMedian * std::sqrt(expected / kBlocks) / largest};
}

SensorDrift driftBeforeContact(const std::vector<SampleHistory::Sample>& samples,
                               const std::vector<ForcePath::Point>& points, double margin,
                               const Eigen::VectorXd& deviations) {
  const auto first = std::find_if(points.begin(), points.end(), [](const auto& point) { return point.touches; });
  const auto free = static_cast<std::size_t>(first - points.begin());
  const double surface = first == points.end() ? -std::numeric_limits<double>::infinity() : samples[free].tip.z();
  double count = 0, time = 0, force = 0, times = 0, both = 0, variance = 0;
  for (std::size_t i = 0; i < free; ++i) {
    if (samples[i].tip.z() < surface + margin) continue;
    const double t = samples[i].time - samples.front().time, f = samples[i].force;
    ++count;
    time += t;
    force += f;
    times += t * t;
    both += t * f;
    variance += std::pow(deviations[static_cast<Eigen::Index>(i)], 2);
  }
  const double spread = times - time * time / std::max(count, 1.0);
  if (count < kFewestFree || !(spread > 0)) return {};
  return {(both - time * force / count) / spread, std::sqrt(variance / count / spread)};
}

}  // namespace microinjection
