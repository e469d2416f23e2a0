#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "cell_microinjection/InjectionPulse.h"
#include "cell_microinjection/InjectorState.h"
#include "cell_microinjection/StringStamped.h"
#include "nodes/runtime/cycle.h"
#include "operation/control/injection_goal.h"

namespace microinjection {

/// The controller's connection to the injector. A pulse is a message with its own id. It is
/// repeated until the pulse is over, so that the pulse does not outlive the controller, with the pressure that is
/// wanted by then: a suction grows. A pulse that is withdrawn before its end becomes a stop.
///
/// In:  /injector/state (InjectorState)
/// Out: /injector/pulse (InjectionPulse), /injector/stop (StringStamped, the reason)
class InjectorLink {
 public:
  /// `timeout`: s, past which the injector's state is stale.
  InjectorLink(Cycle& cycle, double timeout);

  /// The injector's state; empty when it is invalid or in FAULT. A pulse counts as under way from
  /// its message until its end, however short it is, or until it is refused.
  std::optional<InjectorReport> report(const ros::Time& now);

  /// Call once a step, after report(), with the present pulse; empty: none.
  void setPulse(const std::optional<PulseGoal>& pulse, const ros::Time& now);

 private:
  void readRefusal(const std::string& refusal);

  Input<cell_microinjection::InjectorState>& state_;
  Output<cell_microinjection::InjectionPulse>& pulse_;
  Output<cell_microinjection::StringStamped>& stop_;
  bool requested_ = false;
  cell_microinjection::InjectionPulse message_;  ///< the last one published
  std::uint64_t pending_ = 0;                    ///< id of the pulse under way; 0: none
  bool begun_ = false;                           ///< the injector has reported busy for it
  std::string refusal_;                          ///< of the requested pulse; empty: it was not refused
};

}  // namespace microinjection
