#pragma once

#include <vector>

#include "base/config_reader.h"
#include "operation/teleoperation/hand_motion.h"

namespace microinjection {

/// A synthetic motion of a hand, 200 samples a second. Between waypoints the path is one of minimum jerk, which is how
/// hands reach (Flash and Hogan 1985). Physiological tremor of 8 to 12 Hz lies on top; it fades in and out over the
/// first and the last half second.
///
/// Keys:
///   tremor/rms   m, of each axis; default 0, in [0, inf)
///   tremor/seed  default 1
///   path         list of waypoints, reached one after the other from position 0: `duration` (s, to get there), `z` (m,
///                of the haptic device, negative towards the cell), `clutch` (pressed on the way; default false),
///                `phase` (for people)
/// @throws ConfigError
std::vector<HandMotion::Sample> generateMotion(ConfigReader reader);

}  // namespace microinjection
