#include "operation/console/guard_margins.h"

#include <algorithm>
#include <cmath>

#include "operation/console/figures.h"

namespace microinjection {

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

}  // namespace microinjection
