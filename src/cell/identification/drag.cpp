#include "cell/identification/drag.h"

#include <algorithm>
#include <cmath>

#include "base/median.h"

namespace microinjection {
namespace {

constexpr double kFar = 0.5;               // of the way, where there is no cell
constexpr std::size_t kFewestOfPart = 30;  // samples of each part
constexpr double kDeviations = 3;
constexpr double kErrorOfMedian = 1.2533;  // over that of the mean

/// Median of the forces of some samples, with its deviation and their mean time.
struct Part {
  std::size_t count = 0;
  double time = 0, force = 0, deviation = 0;
};

Part partOf(const ForceCurve& curve, const std::vector<std::size_t>& samples, std::size_t begin, std::size_t end) {
  Part part;
  part.count = end - begin;
  if (part.count == 0) return part;
  std::vector<double> forces, steps{0};  // a drift does not change the steps between neighbours
  for (std::size_t i = begin; i < end; ++i) {
    part.time += curve.time[samples[i]] / static_cast<double>(part.count);
    if (!forces.empty()) steps.push_back(std::abs(curve.force[samples[i]] - forces.back()));
    forces.push_back(curve.force[samples[i]]);
  }
  part.force = upperMedian(forces);
  const double noise = 1.4826 / std::sqrt(2.0) * upperMedian(steps);
  part.deviation = kErrorOfMedian * noise / std::sqrt(static_cast<double>(part.count));
  return part;
}

}  // namespace

double dragOf(const ForceCurve& whole) {
  const auto deepest = std::max_element(whole.position.begin(), whole.position.end());
  const auto turn = static_cast<std::size_t>(deepest - whole.position.begin());
  const double lowest = *std::min_element(whole.position.begin(), whole.position.end());
  const double far = lowest + kFar * (*deepest - lowest);
  std::vector<std::size_t> in, out;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (whole.position[i] < far) (i < turn ? in : out).push_back(i);
  }
  const Part first = partOf(whole, in, 0, in.size() / 2), second = partOf(whole, in, in.size() / 2, in.size());
  const Part back = partOf(whole, out, 0, out.size());
  if (first.count < kFewestOfPart || second.count < kFewestOfPart || back.count < kFewestOfPart ||
      second.time <= first.time)
    return 0;
  // The drift of the way in goes on.
  const double ahead = (back.time - second.time) / (second.time - first.time);
  const double expected = second.force + ahead * (second.force - first.force);
  const double deviation =
      std::hypot(back.deviation, std::hypot((1 + ahead) * second.deviation, ahead * first.deviation));
  return std::max(0.0, std::abs(back.force - expected) - kDeviations * deviation);
}

}  // namespace microinjection
