#include "operation/control/hand_observer.h"

#include <algorithm>

namespace microinjection {
namespace {

constexpr double kInside = 1e-6;  ///< m past the contact point that is an indentation; m before it that is out
constexpr double kTurned = 2e-6;  ///< m of reversed motion that is no tremor

}  // namespace

std::optional<InjectionEvent> HandObserver::step(InjectionState state, const NeedleMonitor& monitor,
                                                 const std::optional<InjectorReport>& injector) {
  using State = InjectionState;
  using Event = InjectionEvent;
  const double depth = monitor.depth();
  if (state != state_) deepest_ = shallowest_ = depth;
  state_ = state;
  deepest_ = std::max(deepest_, depth);
  shallowest_ = std::min(shallowest_, depth);
  const bool touches = state == State::kContact || state == State::kIndent || state == State::kPunctured;
  if (touches && monitor.punctured()) return Event::kPuncture;
  if (state == State::kIdle && monitor.ready()) return Event::kStart;
  if (state == State::kApproach && monitor.touched()) return Event::kTouch;
  if (state == State::kContact && monitor.confirmed() && !*monitor.confirmed()) return Event::kLost;
  if (state == State::kContact && depth > kInside && depth >= deepest_) return Event::kIndent;
  if (state == State::kPunctured && injector && injector->busy) return Event::kInject;
  if (state == State::kInject && injector && !injector->busy) return Event::kInjected;
  if ((touches || state == State::kInject) && (deepest_ - depth > kTurned || depth < -kInside)) return Event::kWithdraw;
  if (state == State::kWithdraw && depth < -kInside) return Event::kOut;
  if (state == State::kWithdraw && depth - shallowest_ > kTurned) return Event::kTouch;
  return std::nullopt;
}

}  // namespace microinjection
