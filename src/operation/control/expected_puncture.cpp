#include "operation/control/expected_puncture.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace microinjection {
namespace {

bool isInterval(double low, double high) { return std::isfinite(low) && std::isfinite(high) && low > 0 && high >= low; }

}  // namespace

bool ExpectedPuncture::plausible() const {
  return isInterval(force_low, force_high) && isInterval(depth_low, depth_high);
}

void ExpectationConfig::read(ConfigReader& reader) {
  reader.number("timeout", timeout, Range::positive());
  reader.number("beyond", beyond, Range::nonNegative());
}

std::string unreachable(const ExpectedPuncture& expected, const GuardConfig& guards, double depth) {
  const double deepest = std::min(depth, guards.depth_limit);
  std::ostringstream text;
  if (expected.force_low > guards.force_limit) {
    text << "the puncture is expected above " << expected.force_low
         << " N, allowed is force_limit = " << guards.force_limit << " N";
  } else if (expected.depth_low > deepest) {
    text << "the puncture is expected deeper than " << expected.depth_low << " m, allowed is " << deepest
         << " m, by the goal's depth and depth_limit";
  }
  return text.str();
}

std::string exceeded(const ExpectedPuncture& expected, const ExpectationConfig& config, double force) {
  const double most = (1 + config.beyond) * expected.force_high;
  if (force <= most) return "";
  std::ostringstream text;
  text << "the membrane holds " << force << " N, expected to fail below " << expected.force_high << " N";
  return text.str();
}

}  // namespace microinjection
