#include "operation/console/cell_lines.h"

#include "operation/console/figures.h"

namespace microinjection {

Lamp estimateLamp(const std::optional<CellEstimateView>& estimate) {
  if (!estimate) return {Light::kGrey, "no estimate (estimator:=true)"};
  const std::string interval = figure(estimate->modulus, 1e3, 2) + " kPa (" + figure(estimate->low, 1e3, 2) + " to " +
                               figure(estimate->high, 1e3, 2) + "), ";
  const std::string reason = estimate->reason.empty() ? "" : ": " + estimate->reason;
  const std::string& verdict = estimate->verdict;
  if (verdict == "converged") return {Light::kGreen, interval + verdict};
  return {verdict == "inconsistent" ? Light::kRed : Light::kYellow, interval + verdict + reason};
}

std::string punctureText(const std::optional<CellEstimateView>& estimate) {
  if (!estimate || estimate->puncture_depth == 0) return "";
  return "puncture at " + micro(estimate->puncture_depth, 1) + " um (" + micro(estimate->puncture_low, 1) + " to " +
         micro(estimate->puncture_high, 1) + "), " + micro(estimate->puncture_force, 2) + " uN";
}

std::string injectorText(const InjectorView& injector) {
  return figure(injector.pressure, 1e3, 2) + " kPa, " + figure(injector.volume, 1e-15, 2) + " pL, " +
         std::to_string(injector.pulses) + (injector.pulses == 1 ? " pulse" : " pulses");
}

Lamp injectorLamp(const std::optional<InjectorView>& injector, bool heard) {
  if (!injector) return heard ? Lamp{Light::kRed, "injector is silent"} : Lamp{Light::kGrey, "none"};
  if (!injector->fault.empty()) return {Light::kRed, injector->fault};
  const std::string text = injectorText(*injector);
  if (!injector->refusal.empty()) return {Light::kYellow, text + "; refused: " + injector->refusal};
  return {Light::kGreen, text + (injector->busy ? ", pulse" : "")};
}

}  // namespace microinjection
