#include "operation/display/tip_trail.h"

#include <cstddef>

namespace microinjection {
namespace {

constexpr Colour kTrail{0.45f, 0.95f, 1.00f, 0.9f};
constexpr double kShortest = 0.1e-6;  // m: a needle that rests adds nothing

}  // namespace

void TipTrail::add(double time, const Eigen::Vector3d& tip) {
  if (time < now_) places_.clear();
  now_ = time;
  while (!places_.empty() && places_.front().time < now_ - duration_) places_.pop_front();
  if (places_.empty() || (places_.back().tip - tip).norm() > kShortest) places_.push_back({time, tip});
}

ColouredLines TipTrail::lines(double enlargement) const {
  ColouredLines result;
  for (std::size_t i = 1; i < places_.size(); ++i) {
    for (const Place& place : {places_[i - 1], places_[i]}) {
      Colour colour = kTrail;
      colour.a *= static_cast<float>(1 - (now_ - place.time) / duration_);
      result.lines.push_back(toDisplay(place.tip, enlargement));
      result.colours.push_back(colour);
    }
  }
  return result;
}

}  // namespace microinjection
