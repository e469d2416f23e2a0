#include "display/readout.h"

#include <cstdio>

namespace microinjection {
namespace {

/// Always with `decimals`, so that the text does not jump about as it changes; "-" when there is no value.
std::string fixedFigure(const std::optional<double>& value, double unit, int decimals) {
  if (!value) return "-";
  char figure[64];
  std::snprintf(figure, sizeof figure, "%.*f", decimals, *value / unit);
  return figure;
}

}  // namespace

std::string micro(double value, int digits) {
  char figure[64];
  std::snprintf(figure, sizeof figure, "%.*g", digits, value * 1e6);
  return figure;
}

std::vector<ReadoutLine> lines(const Readout& readout) {
  using About = ReadoutLine::About;
  std::vector<ReadoutLine> result = {
      {About::kState, readout.state},
      {About::kMotion, "depth " + fixedFigure(readout.indentation, 1e-6, 2) + " um"},
      {About::kPredicted, "predicted " + fixedFigure(readout.predicted, 1e-6, 3) + " uN"},
      {About::kMeasured, "measured " + fixedFigure(readout.measured, 1e-6, 3) + " uN"}};
  if (readout.hand) result.push_back({About::kMotion, "hand " + fixedFigure(readout.hand->z(), 1e-3, 1) + " mm"});
  return result;
}

}  // namespace microinjection
