#include "cell/model/crack_speed.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kSmoothing = 0.01;              ///< s: poses have noise
constexpr int kOnsets = 17, kOnsetsOfTwice = 4;  ///< in all: up to 16 times the toughness; between it and its double

}  // namespace

CrackSpeed::CrackSpeed(const PiercedBranch& branch, const PunctureConfig::ToughnessRate& rate) : rate_(rate) {
  const int count = std::isfinite(rate.speed) ? kOnsets : 1;
  for (int i = 0; i < count; ++i) {
    const double factor = std::exp2(static_cast<double>(i) / kOnsetsOfTwice);
    const std::optional<PiercedBranch::Onset> onset = i == 0 ? branch.onset() : branch.tougher(factor).onset();
    if (!onset) break;
    onsets_.push_back(*onset);
  }
}

void CrackSpeed::step(double advance, double duration) {
  if (!(duration > 0)) return;
  speed_ += (advance / duration - speed_) * -std::expm1(-duration / kSmoothing);
  if (std::isfinite(rate_.speed)) tougher_ = 1 + std::pow(std::max(speed_, 0.0) / rate_.speed, rate_.exponent);
}

double CrackSpeed::at(double PiercedBranch::Onset::*value) const {
  const double place = kOnsetsOfTwice * std::log2(tougher_);
  const auto below = static_cast<std::size_t>(place);
  if (below >= onsets_.size()) return std::numeric_limits<double>::infinity();
  const double first = onsets_[below].*value, part = place - static_cast<double>(below);
  if (part == 0) return first;
  if (below + 1 == onsets_.size()) return std::numeric_limits<double>::infinity();
  return first + part * (onsets_[below + 1].*value - first);
}

}  // namespace microinjection
