#include "cell/identification/frozen_readings.h"

#include <algorithm>
#include <cmath>

#include "base/median.h"

namespace microinjection {
namespace {

constexpr std::size_t kFewestEqual = 10;  ///< equal readings in a row
constexpr std::size_t kLastFewest = 25;   ///< the same, at the end of a record
constexpr double kJump = 4;               ///< behind them, over the median step from reading to reading
constexpr double kConverterSteps = 3;     ///< same, over the converter's step

/// Median of the steps between readings that differ, and the smallest of them.
struct Steps {
  double median = 0, least = 0;
};

Steps stepsOf(const std::vector<double>& force) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < force.size(); ++i) {
    if (force[i] != force[i - 1]) steps.push_back(std::abs(force[i] - force[i - 1]));
  }
  if (steps.empty()) return {};
  return {upperMedian(steps), *std::min_element(steps.begin(), steps.end())};
}

/// Whether equal readings in a row are usual among the first `count`: the converter's step is above the noise.
bool isCoarse(const std::vector<double>& force, std::size_t count) {
  std::size_t equal = 0;
  for (std::size_t i = 1; i < count; ++i) equal += force[i] == force[i - 1];
  return 2 * equal > count;
}

}  // namespace

ForceCurve withoutFrozenReadings(const ForceCurve& curve) {
  const Steps steps = stepsOf(curve.force);
  ForceCurve result = curve;
  result.time.clear();
  result.position.clear();
  result.force.clear();
  std::size_t removed = 0;
  for (std::size_t begin = 0, end = 0; begin < curve.size(); begin = end) {
    end = begin + 1;
    while (end < curve.size() && curve.force[end] == curve.force[begin]) ++end;
    const double jump = end < curve.size() ? std::abs(curve.force[end] - curve.force[begin]) : 0;
    const bool jumps = jump > std::max(kJump * steps.median, kConverterSteps * steps.least);
    // A record that ends with a sensor that hangs has no jump. Elsewhere it had noise, and the tip still moves.
    const double moved = std::abs(curve.position[end - 1] - curve.position[begin]);
    const bool ends = end == curve.size() && end - begin >= kLastFewest && moved > 0 && end - begin < curve.size();
    const bool hung = end - begin >= kFewestEqual && (jumps || (ends && !isCoarse(curve.force, begin)));
    const std::size_t kept = hung ? begin + 1 : end;
    removed += end - kept;
    for (std::size_t i = begin; i < kept; ++i) {
      result.time.push_back(curve.time[i]);
      result.position.push_back(curve.position[i]);
      result.force.push_back(curve.force[i]);
    }
  }
  if (removed > 0) result.notes.push_back(std::to_string(removed) + " readings of a sensor that hung are left out");
  return result;
}

}  // namespace microinjection
