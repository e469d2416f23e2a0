#include "operation/display/readout.h"

#include <cstddef>
#include <cstdio>
#include <sstream>

namespace microinjection {
namespace {

/// Always with `decimals` digits, so that the text keeps its place when it changes; "-" without a
/// value.
std::string fixedFigure(const std::optional<double>& value, double unit, int decimals) {
  if (!value) return "-";
  char figure[64];
  std::snprintf(figure, sizeof figure, "%.*f", decimals, *value / unit);
  return figure;
}

/// Breaks a text at spaces into at most `most` lines of `width` characters; a longer word is not
/// broken.
std::vector<std::string> wrapped(const std::string& text, std::size_t width, std::size_t most) {
  std::vector<std::string> result;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!result.empty() && result.back().size() + 1 + word.size() <= width) {
      result.back() += " " + word;
    } else if (result.size() < most) {
      result.push_back(word);
    } else {
      result.back() += " ...";
      break;
    }
  }
  return result;
}

void addForce(std::vector<ReadoutLine>& result, ReadoutLine::About about, const std::string& name,
              const std::optional<ForceParts>& force) {
  const auto figure = [&](double ForceParts::*part) {
    return fixedFigure(force ? std::optional((*force).*part) : std::nullopt, 1e-6, 3) + " uN";
  };
  result.push_back({about, name + " " + figure(&ForceParts::along)});
  result.push_back({about, "  across " + figure(&ForceParts::across)});
}

}  // namespace

ForceParts partsOf(const Eigen::Vector3d& force, const Eigen::Vector3d& axis) {
  const double along = force.dot(axis);
  return {along, (force - along * axis).norm()};
}

std::string micro(double value, int digits) {
  char figure[64];
  std::snprintf(figure, sizeof figure, "%.*g", digits, value * 1e6);
  return figure;
}

std::vector<ReadoutLine> lines(const Readout& readout) {
  using About = ReadoutLine::About;
  constexpr std::size_t kWidth = 20, kMostStateLines = 5;
  std::vector<ReadoutLine> result;
  for (const std::string& part : wrapped(readout.state, kWidth, kMostStateLines))
    result.push_back({About::kState, part});
  if (!readout.injection.empty()) result.push_back({About::kMotion, readout.injection});
  result.push_back({About::kMotion, "depth " + fixedFigure(readout.indentation, 1e-6, 2) + " um"});
  addForce(result, About::kPredicted, "predicted", readout.predicted);
  addForce(result, About::kMeasured, "measured", readout.measured);
  if (readout.puncture) {
    const PunctureDepth& puncture = *readout.puncture;
    if (puncture.beyond) {
      result.push_back({About::kMotion, "puncture below " + micro(puncture.low, 3) + " um"});
    } else {
      result.push_back({About::kMotion, "puncture at " + micro(puncture.depth, 3) + " um"});
      result.push_back({About::kMotion, "  and " + micro(puncture.force, 3) + " uN"});
    }
  }
  if (readout.hand) result.push_back({About::kMotion, "hand " + fixedFigure(readout.hand->z(), 1e-3, 1) + " mm"});
  return result;
}

}  // namespace microinjection
