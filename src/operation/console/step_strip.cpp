#include "operation/console/step_strip.h"

#include <cstddef>

namespace microinjection {

constexpr std::array<InjectionState, 8> StepStrip::kSteps;

namespace {

InjectionState stepOf(InjectionState state) {
  if (state == InjectionState::kHold) return InjectionState::kIdle;
  return state == InjectionState::kRelease ? InjectionState::kWithdraw : state;
}

}  // namespace

const char* StepStrip::text(std::size_t step) const {
  return toText(marks_[step] == Mark::kPresent ? *state_ : kSteps[step]);
}

/// A second layer leads from punctured back to indent: what was passed stays so until the needle
/// starts anew.
void StepStrip::update(std::optional<InjectionState> state) {
  const std::optional<InjectionState> step = state ? std::optional(stepOf(*state)) : std::nullopt;
  const bool anew = step == InjectionState::kIdle || (state == InjectionState::kApproach && state_ != state);
  for (std::size_t i = 0; i < kSteps.size(); ++i) {
    if (marks_[i] == Mark::kPresent) marks_[i] = Mark::kPassed;
    if (anew) marks_[i] = Mark::kAhead;
    if (step == kSteps[i]) marks_[i] = Mark::kPresent;
  }
  state_ = state;
}

}  // namespace microinjection
