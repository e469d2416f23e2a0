#pragma once

#include <array>
#include <optional>

#include "operation/control/injection_state.h"

namespace microinjection {

/// The steps of an injection, and which of them were passed since the needle started. The cell is taken before and let
/// go behind them, with the needle at rest: the first step is that of hold, the last one that of release.
class StepStrip {
 public:
  enum class Mark { kAhead, kPassed, kPresent };
  static constexpr std::array<InjectionState, 8> kSteps = {
      InjectionState::kIdle,     InjectionState::kApproach,  InjectionState::kContact, InjectionState::kIndent,
      InjectionState::kAspirate, InjectionState::kPunctured, InjectionState::kInject,  InjectionState::kWithdraw};

  /// `state`: of the newest message; empty: not known, then no step is lit.
  void update(std::optional<InjectionState> state);

  const std::array<Mark, kSteps.size()>& marks() const { return marks_; }
  /// Of a step, for people: that of the state while it is present.
  const char* text(std::size_t step) const;
  /// No step is lit because the rig is at fault.
  bool fault() const { return state_ == InjectionState::kFault; }

 private:
  std::array<Mark, kSteps.size()> marks_{};
  std::optional<InjectionState> state_;
};

}  // namespace microinjection
