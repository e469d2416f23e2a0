#pragma once

#include <vector>

#include "base/config_reader.h"
#include "operation/teleoperation/hand_motion.h"

namespace microinjection {

/// Generates the motion of a hand with 200 samples a second. The paths between waypoints have
/// minimum jerk, as human reaching has (Flash and Hogan 1985). A physiological tremor of 8 to 12 Hz
/// is added; it fades in and out over the first and the last half second.
///
/// Keys:
///   tremor/rms   m, on each axis; default 0, in [0, inf)
///   tremor/seed  default 1
///   path         list of waypoints in order, from position 0: `duration` (s) of the path to it,
///                `z` (m, haptic device, negative towards the cell), `clutch` (pressed on that
///                path; default false), `phase` (text for people)
/// @throws ConfigError
std::vector<HandMotion::Sample> generateMotion(ConfigReader reader);

}  // namespace microinjection
