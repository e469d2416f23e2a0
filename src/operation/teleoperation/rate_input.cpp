#include "operation/teleoperation/rate_input.h"

#include <cmath>

namespace microinjection {

RateInputConfig RateInputConfig::read(ConfigReader& reader) {
  RateInputConfig config;
  reader.vector("axes", config.axes, Range::closed(0, 31));
  reader.vector("deflection", config.deflection, Range::closed(-1, 1));
  reader.number("centre", config.centre, Range::open(0, 1));
  reader.integer("dead_man", config.dead_man, Range::closed(-1, 63));
  if (config.axes != config.axes.array().round().matrix()) reader.error("axes", "must be whole numbers");
  return config;
}

std::optional<RateInput::Reading> RateInput::read(const std::vector<float>& axes, const std::vector<int>& buttons) {
  Eigen::Vector3d share;
  for (int i = 0; i < 3; ++i) {
    const auto index = static_cast<std::size_t>(config_.axes[i]);
    // A space mouse reaches only about 1 at its stop. The negated comparison also rejects NaN.
    if (index >= axes.size() || !(std::abs(axes[index]) <= 1.5)) return std::nullopt;
    share[i] = axes[index];
  }
  if (config_.dead_man >= static_cast<int>(buttons.size())) return std::nullopt;
  const bool held = config_.dead_man < 0 || buttons[config_.dead_man] != 0;
  released_ = held && (released_ || share.cwiseAbs().maxCoeff() < config_.centre);
  return Reading{share.cwiseProduct(config_.deflection), released_};
}

}  // namespace microinjection
