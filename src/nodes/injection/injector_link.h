#pragma once

#include <ros/ros.h>

#include <cstdint>
#include <optional>

#include "cell_microinjection/InjectionPulse.h"
#include "cell_microinjection/InjectorState.h"
#include "cell_microinjection/StringStamped.h"
#include "nodes/runtime/cycle.h"
#include "operation/control/injection_goal.h"

namespace microinjection {

/// The controller's line to the injector: a pulse that is wanted becomes a message with an id of its own, said again
/// until it is over, so that it does not outlive the controller; one that is not wanted any more before it is over
/// becomes a stop.
///
/// In:  /injector/state (InjectorState)
/// Out: /injector/pulse (InjectionPulse), /injector/stop (StringStamped, the reason)
class InjectorLink {
 public:
  /// `timeout`: s, past which the injector's state is stale.
  InjectorLink(Cycle& cycle, double timeout);

  /// What the injector says; empty where it says nothing valid, or is in FAULT. From the moment it was
  /// sent until it is over a pulse counts as under way, however short it is.
  std::optional<InjectorReport> report(const ros::Time& now);

  /// Once a step, after report(): what is wanted now; empty: no pulse.
  void want(const std::optional<PulseGoal>& pulse, const ros::Time& now);

 private:
  Input<cell_microinjection::InjectorState>& state_;
  Output<cell_microinjection::InjectionPulse>& pulse_;
  Output<cell_microinjection::StringStamped>& stop_;
  bool wanted_ = false;
  cell_microinjection::InjectionPulse message_;  ///< the last one that was sent
  std::uint64_t pending_ = 0;                    ///< id of the pulse that is not over yet as far as is known; 0: none
  bool begun_ = false;                           ///< the injector has said that it is busy since that was sent
};

}  // namespace microinjection
