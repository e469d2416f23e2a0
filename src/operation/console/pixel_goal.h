#pragma once

#include <Eigen/Core>
#include <optional>

#include "operation/console/console_commands.h"

namespace microinjection {

/// A place of the microscope's image that a click has proposed for the tip. The needle goes there
/// after the operator has confirmed it.
struct PixelGoal {
  std::optional<Eigen::Vector2d> pixel;  ///< px: the centre of the top-left pixel is 0, x is right, y down
  bool under_way = false;                ///< confirmed, and the needle is on its way
};

/// What the button Go does now.
/// @param there  the node that leads the needle by images answers
CommandOffer offer(const PixelGoal& goal, const SessionView& session, bool there);

/// Why the needle cannot be led over /teleop/servo_cp now, as far as the console knows; empty: it can.
std::string refusalOfLeading(const SessionView& session);

}  // namespace microinjection
