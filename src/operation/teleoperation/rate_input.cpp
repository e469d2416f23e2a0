#include "operation/teleoperation/rate_input.h"

#include <cmath>

namespace microinjection {
namespace {

constexpr double kLargestZero = 0.3;  ///< share of an axis: a device that rests farther off is broken
constexpr double kRest = 1;           ///< s without a change, after which a small deflection is a zero

}  // namespace

RateInputConfig RateInputConfig::read(ConfigReader& reader) {
  RateInputConfig config;
  reader.vector("axes", config.axes, Range::closed(0, 31));
  reader.vector("deflection", config.deflection, Range::closed(-1, 1));
  reader.number("centre", config.centre, Range::open(0, 1));
  reader.integer("dead_man", config.dead_man, Range::closed(-1, 63));
  reader.number("renewal", config.renewal, Range::positive());
  if (config.axes != config.axes.array().round().matrix()) reader.error("axes", "must be whole numbers");
  return config;
}

RateInput::RateInput(const RateInputConfig& config) : config_(config), deflection_(config.renewal), rest_(kRest) {}

std::optional<RateInput::Reading> RateInput::read(const std::vector<float>& axes, const std::vector<int>& buttons,
                                                  double time) {
  Eigen::Vector3d raw;
  for (int i = 0; i < 3; ++i) {
    const auto index = static_cast<std::size_t>(config_.axes[i]);
    // A space mouse reaches only about 1 at its stop. The negated comparison also rejects NaN.
    if (index >= axes.size() || !(std::abs(axes[index]) <= 1.5)) return std::nullopt;
    raw[i] = axes[index];
  }
  if (config_.dead_man >= static_cast<int>(buttons.size())) return std::nullopt;
  const double dt = time - time_;
  time_ = time;
  if (rest_.step(raw, dt) && raw.cwiseAbs().maxCoeff() <= kLargestZero) zero_ = raw;
  // Within `centre` of either zero: a device that was off its zero may come back to the true one.
  Eigen::Vector3d share = raw - zero_;
  if (raw.cwiseAbs().maxCoeff() < config_.centre) share.setZero();
  const double deflected = share.cwiseAbs().maxCoeff();
  if (deflected < config_.centre) deflection_.reset();
  if (deflection_.step(raw, dt * deflected)) {
    released_ = false;
    return std::nullopt;
  }
  const bool held = config_.dead_man < 0 || buttons[config_.dead_man] != 0;
  released_ = held && (released_ || deflected < config_.centre);
  return Reading{share.cwiseProduct(config_.deflection), released_};
}

}  // namespace microinjection
