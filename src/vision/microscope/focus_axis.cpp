#include "vision/microscope/focus_axis.h"

#include <algorithm>

namespace microinjection {

FocusAxisConfig FocusAxisConfig::read(ConfigReader& reader) {
  FocusAxisConfig config;
  reader.vector("range", config.range, Range::closed(-1e-2, 1e-2));
  reader.number("speed", config.speed, Range::positive());
  reader.number("start", config.start);
  if (config.range.x() >= config.range.y()) reader.error("range", "must be the lowest and the highest position");
  if (config.start < config.range.x() || config.start > config.range.y()) reader.error("start", "must be within range");
  return config;
}

void FocusAxis::step(double duration) {
  const double reach = config_.speed * duration;
  position_ = std::clamp(goal_, position_ - reach, position_ + reach);
}

}  // namespace microinjection
