#include "nodes/injection/injector_link.h"

#include <cmath>

namespace microinjection {
namespace {

constexpr double kRepetition = 0.05;  // s

}  // namespace

InjectorLink::InjectorLink(Cycle& cycle, double timeout)
    : state_(cycle.input<cell_microinjection::InjectorState>("injector/state", InputPhase::kSampled, timeout)),
      pulse_(cycle.output<cell_microinjection::InjectionPulse>("injector/pulse")),
      stop_(cycle.output<cell_microinjection::StringStamped>("injector/stop")) {}

std::optional<InjectorReport> InjectorLink::report(const ros::Time& now) {
  const auto* state = state_.get(now);
  if (!state) return std::nullopt;
  readRefusal(state->refusal);
  // A fault may be why it was refused.
  if (!refusal_.empty()) return InjectorReport{state->busy, 0, false, refusal_};
  if (!state->fault.empty() || !std::isfinite(state->volume + state->pressure + state->flow)) return std::nullopt;
  if (pending_ != 0) {
    const bool over = state->last_id == pending_ || (begun_ && !state->busy);
    begun_ = begun_ || state->busy;
    if (over) pending_ = 0;
  }
  return InjectorReport{
      state->busy || pending_ != 0, state->volume, state->last_id == message_.id, "", state->pressure, state->flow};
}

/// The injector tells why its last command was refused: "pulse 5 refused: ...". Other commands may follow.
void InjectorLink::readRefusal(const std::string& refusal) {
  if (pending_ == 0 || refusal.empty()) return;
  const std::string begin = "pulse " + std::to_string(message_.id) + " refused: ";
  if (refusal.compare(0, begin.size(), begin) != 0) return;
  refusal_ = refusal.substr(begin.size());
  pending_ = 0;
}

void InjectorLink::setPulse(const std::optional<PulseGoal>& pulse, const ros::Time& now) {
  if (pulse && !requested_) {
    message_.header.stamp = now;
    message_.id = pending_ = now.toNSec();  // unique, also after a restart of this node; reproducible in virtual time
    message_.pressure = pulse->pressure;
    message_.duration = pulse->duration;
    message_.held = true;
    pulse_.publish(message_);
    begun_ = false;
  }
  if (!pulse || !requested_) refusal_.clear();
  if (pulse && pending_ != 0 && isDue(message_.header.stamp, now, kRepetition)) {
    message_.header.stamp = now;
    message_.pressure = pulse->pressure;
    pulse_.publish(message_);
  }
  if (!pulse && requested_ && pending_ != 0) {
    cell_microinjection::StringStamped message;
    message.header.stamp = now;
    message.string = "the controller ended the pulse";
    stop_.publish(message);
    pending_ = 0;
  }
  requested_ = pulse.has_value();
}

}  // namespace microinjection
