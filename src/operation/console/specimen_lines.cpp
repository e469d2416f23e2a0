#include "operation/console/specimen_lines.h"

#include <cmath>

#include "operation/console/figures.h"

namespace microinjection {
namespace {

using Verdict = FindingView::Verdict;

Light lightOf(Verdict verdict) {
  return verdict == Verdict::kFound ? Light::kGreen : verdict == Verdict::kUncertain ? Light::kYellow : Light::kGrey;
}

const char* nameOf(Verdict verdict) {
  return verdict == Verdict::kFound ? "found" : verdict == Verdict::kUncertain ? "uncertain" : "not found";
}

}  // namespace

Lamp findingLine(const std::string& name, const FindingView& finding) {
  const std::string reason = finding.reason.empty() ? "" : ": " + finding.reason;
  return {lightOf(finding.verdict), name + ": " + nameOf(finding.verdict) + reason};
}

Lamp findingLine(const std::string& name, const FindingView& finding, const std::string& length_name, double length,
                 double deviation, double pixel_size) {
  Lamp lamp = findingLine(name, finding);
  if (finding.verdict == Verdict::kNotFound || !std::isfinite(length) || !std::isfinite(deviation)) return lamp;
  const bool in_metres = pixel_size > 0;
  const double unit = in_metres ? 1e-6 / pixel_size : 1;
  lamp.text = name + ": " + nameOf(finding.verdict) + ", " + length_name + " " + figure(length, unit, 1) + " +- " +
              figure(deviation, unit, in_metres ? 2 : 1) + (in_metres ? " um" : " px") +
              (finding.reason.empty() ? "" : ": " + finding.reason);
  return lamp;
}

double scaleBar(double longest) {
  if (!(longest > 0) || !std::isfinite(longest)) return 0;
  const double power = std::pow(10, std::floor(std::log10(longest)));
  for (const double step : {5.0, 2.0}) {
    if (step * power <= longest) return step * power;
  }
  return power;
}

}  // namespace microinjection
