#include "cell/estimation/cell_follower.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kSame = 1e-6;           // relative, of a modulus that is served as asked
constexpr double kSameHeight = 1e-9;     // m, same
constexpr double kLargestRise = 0.2e-6;  // m at once: PlacedCell takes 20 ms, as MemberChange for the modulus
constexpr double kPatience = 0.5;        // s, after which a change that is not served is asked for again

}  // namespace

void CellFollowerConfig::read(ConfigReader& reader) {
  reader.number("serve_period", period, Range::closed(0.02, 10));
  reader.number("least_change", least_change, Range::closed(1e-4, 0.5));
  reader.number("largest_change", largest_change, Range::closed(0.01, 2));
  reader.number("least_height", least_height, Range::closed(1e-9, 1e-6));
  reader.number("largest_height", largest_height, Range::closed(0, 20e-6));
}

bool CellFollower::isServed() const {
  return !asked_ || (std::abs(served_.modulus / asked_->modulus - 1) < kSame &&
                     std::abs(served_.height - asked_->height) < kSameHeight);
}

std::optional<CellFollower::Properties> CellFollower::ask(const Properties& found, double time) {
  const bool is_served = isServed();
  const double passed = time - asked_at_;  // negative: time was set back
  if (asked_ && passed >= 0 && passed < (is_served ? config_.period : kPatience)) return std::nullopt;
  refused_ = !is_served;
  const double change = std::log(found.modulus / served_.modulus);
  const double height = std::clamp(found.height, -config_.largest_height, config_.largest_height);
  const double rise = height - served_.height;
  if (std::abs(change) < config_.least_change && std::abs(rise) < config_.least_height) return std::nullopt;
  const double share = std::min({1.0, config_.largest_change / std::abs(change), kLargestRise / std::abs(rise)});
  asked_at_ = time;
  asked_ = {served_.modulus * std::exp(share * change), served_.height + share * rise};
  return asked_;
}

}  // namespace microinjection
