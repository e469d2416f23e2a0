#pragma once

#include <Eigen/Core>
#include <optional>

#include "operation/console/console_commands.h"

namespace microinjection {

/// What the console knows of the needle that it moves by steps, beside the controller.
struct NeedleView {
  std::optional<Eigen::Vector3d> tip;   ///< m, in `world`; empty: not known, or not for too long
  std::optional<Eigen::Vector3d> goal;  ///< m, of the last step, while the needle may be on its way
  std::optional<OperatingState> state;  ///< of the micromanipulator; empty: none was heard
  bool busy = false;                    ///< it moves, by a step or by another node's command
  bool calibrating = false;             ///< the action /calibration/calibrate moves it
};

/// Where a step (m, in `world`) leads. Steps add up: the next one need not wait for the needle.
Eigen::Vector3d needleGoal(const NeedleView& needle, const Eigen::Vector3d& step);

/// What the buttons of the steps do now. One node at a time may command the needle: the controller has to be DISABLED,
/// or absent; one that is silent may go on at any time. The micromanipulator has refusals of its own, as of travel and
/// obstacles, which its lamp shows.
CommandOffer offerNeedleStep(const NeedleView& needle, const SessionView& session);

}  // namespace microinjection
