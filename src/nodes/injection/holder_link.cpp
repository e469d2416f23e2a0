#include "nodes/injection/holder_link.h"

#include <cmath>

namespace microinjection {
namespace {

constexpr double kSetPointRepetition = 0.2;  ///< s
constexpr double kSetPointPatience = 2;      ///< s, past which one that the holder does not take is given up
constexpr double kSeenTimeout = 0.5;         ///< s, of an image of the cell

}  // namespace

HolderLink::HolderLink(Cycle& cycle, double timeout)
    : state_(cycle.input<cell_microinjection::HolderState>("holder/state", InputPhase::kSampled, timeout)),
      hold_(cycle.input<cell_microinjection::CellHold>("cell/hold", InputPhase::kSampled, timeout)),
      seen_(cycle.input<cell_microinjection::VisionState>("vision/state", InputPhase::kSampled, kSeenTimeout)),
      pressure_(cycle.output<sensor_msgs::FluidPressure>("holder/set_pressure")) {
  hold_.optional = seen_.optional = true;
}

std::optional<HolderReport> HolderLink::report(const ros::Time& now) const {
  const auto* state = state_.get(now);
  if (!state || !std::isfinite(state->pressure + state->line_pressure + state->flow)) return std::nullopt;
  return HolderReport{state->pressure, state->line_pressure, state->flow,
                      state->fault.empty() ? state->refusal : state->fault};
}

std::optional<HoldReport> HolderLink::cell(const ros::Time& now) const {
  if (const auto* hold = hold_.get(now)) return HoldReport{hold->mode == "held", hold->mode};
  const auto* seen = seen_.get(now);
  if (!seen || seen->hold.verdict != cell_microinjection::HoldInImage::FOUND) return std::nullopt;
  return HoldReport{seen->hold.held != 0, seen->hold.held ? "held" : "away from its mouth"};
}

void HolderLink::command(const std::optional<HolderCommand>& command, const ros::Time& now) {
  const bool is_new = command && command->number != last_.number;
  if (is_new) {
    last_ = *command;
    delivered_ = false;
    asked_ = now;
  }
  if (delivered_) return;
  const auto* state = state_.get(now);
  delivered_ = !is_new && ((state && state->target == last_.pressure) || isDue(asked_, now, kSetPointPatience));
  if (delivered_ || (!is_new && !isDue(sent_, now, kSetPointRepetition))) return;
  sensor_msgs::FluidPressure message;
  message.header.stamp = sent_ = now;
  message.fluid_pressure = last_.pressure;
  pressure_.publish(message);
}

}  // namespace microinjection
