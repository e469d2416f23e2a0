#include "operation/control/holding.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace microinjection {
namespace {

constexpr double kLeastPressureError = 20;  // Pa: what a line's model or gauge is good for

}  // namespace

HoldingConfig HoldingConfig::read(ConfigReader& reader) {
  HoldingConfig config;
  reader.number("pressure_error", config.pressure_error, {0, 1, true, true});
  reader.number("leak", config.leak, Range::positive());
  reader.number("rest", config.rest, Range::nonNegative());
  return config;
}

void Holding::ask(double pressure) { command_ = HolderCommand{command_ ? command_->number + 1 : 1, pressure}; }

void Holding::begin(Phase phase, const HoldingGoal& goal, double pressure) {
  phase_ = phase;
  goal_ = goal;
  ask(pressure);
  time_ = rested_ = 0;
  failure_.clear();
}

bool Holding::isSealed(const HolderReport& holder, const std::optional<HoldReport>& cell) const {
  return std::abs(holder.flow) <= config_.leak && (!cell || cell->held);
}

void Holding::judge(const std::optional<HolderReport>& holder, const std::optional<HoldReport>& cell) {
  loss_.clear();
  if (cell && !cell->held) loss_ = "the holding pipette does not hold the cell, it is " + cell->mode;
  if (!loss_.empty() || phase_ != Phase::kHeld || !holder || isSealed(*holder, cell)) return;
  std::ostringstream text;
  text << "the holding pipette does not hold the cell: " << std::abs(holder->flow) << " m^3/s flow through its mouth";
  loss_ = text.str();
}

void Holding::step(const std::optional<HolderReport>& holder, const std::optional<HoldReport>& cell, double dt) {
  time_ += dt;
  if (phase_ == Phase::kTaking) stepTaking(holder, cell, dt);
  if (phase_ == Phase::kReleasing) stepReleasing(holder, cell, dt);
  judge(holder, cell);
}

void Holding::stepTaking(const std::optional<HolderReport>& holder, const std::optional<HoldReport>& cell, double dt) {
  const double within = std::max(config_.pressure_error * goal_.suction, kLeastPressureError);
  const bool sealed = holder && isSealed(*holder, cell);
  const bool has_it = sealed && std::abs(holder->pressure + goal_.suction) <= within;
  rested_ = has_it ? rested_ + dt : 0;
  if (has_it && rested_ >= config_.rest) phase_ = Phase::kHeld;
  if (phase_ == Phase::kHeld || time_ < goal_.time) return;
  phase_ = Phase::kFailed;
  const bool follows = holder && holder->problem.empty();
  failure_ = follows && !sealed ? "the cell does not close the mouth of the holding pipette" : unreached(holder);
}

std::string Holding::unreached(const std::optional<HolderReport>& holder) {
  if (!holder) return "no valid state of the holder";
  if (!holder->problem.empty()) return "the holder does not take its pressure: " + holder->problem;
  return "the pressure in the mouth of the holding pipette is not reached";
}

void Holding::stepReleasing(const std::optional<HolderReport>& holder, const std::optional<HoldReport>& cell,
                            double dt) {
  const bool has_suction = !holder || holder->line < -kLeastPressureError;
  rested_ = has_suction ? 0 : rested_ + dt;
  const bool held = cell && cell->held;
  const bool over = rested_ >= goal_.release_time && !has_suction && !held;
  if (!over && time_ < goal_.time) return;
  if (!over)
    failure_ = "the cell was not let go: " + (has_suction ? unreached(holder) : std::string("it is still held"));
  phase_ = Phase::kIdle;
  ask(0);
}

}  // namespace microinjection
