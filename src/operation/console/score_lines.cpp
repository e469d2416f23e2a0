#include "operation/console/score_lines.h"

#include "operation/console/figures.h"

namespace microinjection {
namespace {

constexpr double kSame = 1e-6;  // relative: a count

Light lightOf(const TrainingMeasure& measure, double share) {
  if (measure.exact && share < 1 - kSame) return Light::kGrey;
  if (share <= 1 + kSame) return Light::kGreen;
  return share < 2 ? Light::kYellow : Light::kRed;
}

GuardMargin marginOf(const TrainingMeasure& measure) {
  GuardMargin margin;
  margin.name = measure.name;
  const bool asked = measure.reference > 0;
  margin.share = asked ? measure.value / measure.reference : measure.value > 0 ? 2 : 1;
  const std::string unit = *measure.unit ? std::string(" ") + measure.unit : "";
  const int decimals = *measure.unit ? 2 : 0;
  margin.lamp.text = figure(measure.value, measure.scale, decimals) + " of " +
                     figure(measure.reference, measure.scale, decimals) + unit;
  margin.lamp.light = lightOf(measure, margin.share);
  return margin;
}

}  // namespace

std::vector<GuardMargin> scoreMargins(const TrainingScore& score, const TrainingTask& task) {
  std::vector<GuardMargin> margins;
  for (const TrainingMeasure& measure : score.measures(task)) margins.push_back(marginOf(measure));
  return margins;
}

std::string scoreText(const TrainingScore& score) {
  if (score.outcome != TrainingOutcome::kComplete) return "ended now: no points, " + score.reason;
  return "ended now: " + figure(score.score(), 1, 0) + " of 100 points";
}

}  // namespace microinjection
