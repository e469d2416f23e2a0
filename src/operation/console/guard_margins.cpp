#include "operation/console/guard_margins.h"

#include <algorithm>
#include <cmath>

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

GuardMargin guardMargin(const std::string& name, std::optional<double> value, std::optional<double> limit,
                        const std::string& unit) {
  GuardMargin margin{name, 0, {Light::kGrey, "limit not known"}};
  if (!limit || !(*limit > 0)) return margin;
  const std::string of = " of " + micro(*limit, 1) + " " + unit;
  margin.lamp.text = "-" + of;
  if (!value || !std::isfinite(*value)) return margin;
  // A force guard holds in both directions; a needle above the contact point has no depth.
  margin.share = std::abs(*value) / *limit;
  margin.lamp.text = micro(std::abs(*value), 2) + of;
  margin.lamp.light = margin.share > 1 ? Light::kRed : margin.share >= kNear ? Light::kYellow : Light::kGreen;
  return margin;
}

GuardMargin forceMargin(const SessionView& session) {
  const auto value = session.connected() ? std::optional(session.guard_force) : std::nullopt;
  return guardMargin("Force", value, session.settings.force_limit, "uN");
}

GuardMargin depthMargin(const SessionView& session) {
  const auto value = session.connected() ? std::optional(std::max(0.0, session.depth)) : std::nullopt;
  return guardMargin("Depth", value, session.settings.depth_limit, "um");
}

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
