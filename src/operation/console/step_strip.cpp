#include "operation/console/step_strip.h"

#include <cstddef>

namespace microinjection {

constexpr std::array<InjectionState, 8> StepStrip::kSteps;

/// A second layer leads from punctured back to indent: what was passed stays so until the needle
/// starts anew.
void StepStrip::update(std::optional<InjectionState> state) {
  const bool anew = state == InjectionState::kIdle || (state == InjectionState::kApproach && state_ != state);
  for (std::size_t i = 0; i < kSteps.size(); ++i) {
    if (marks_[i] == Mark::kPresent) marks_[i] = Mark::kPassed;
    if (anew) marks_[i] = Mark::kAhead;
    if (state == kSteps[i]) marks_[i] = Mark::kPresent;
  }
  state_ = state;
}

}  // namespace microinjection
